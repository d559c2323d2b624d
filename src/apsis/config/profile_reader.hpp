#pragma once

#include <apsis/config/case_text.hpp>
#include <apsis/model/gas_scales.hpp>

#include <optional>

namespace apsis {

/// Replaces `profile = { file = "results/earlier/solution.h5", side = "right" }` in the table of a face by
/// values of rho, u and T. These are the values in the cells of an earlier result at one of its sides. They
/// become numbers on a line, formulas table(y, …) in the plane, and table2(z, y, …) in space
/// (formula_table.hpp). Throws input_error at the place of the key if there is no such result or side. Also
/// throws it for another number of space dimensions, other units, or values that are given twice.
void read_profiles(case_text& text, const std::optional<gas_scales>& scales);

}  // namespace apsis
