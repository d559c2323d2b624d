#pragma once

#include <apsis/config/case_text.hpp>
#include <apsis/model/gas_scales.hpp>

#include <optional>

namespace apsis {

/// Replaces `profile = { file = "results/earlier/solution.h5", side = "right" }` of the table of a face by
/// the values of rho, u and T in the cells of an earlier result at one of its sides: numbers on a line,
/// formulas table(y, …) along the side of a plane, table2(z, y, …) over that of a space (formula_table.hpp).
/// Throws input_error at the place of the key: no such result or side, another number of space dimensions,
/// other units, or values that are given twice.
void read_profiles(case_text& text, const std::optional<gas_scales>& scales);

}  // namespace apsis
