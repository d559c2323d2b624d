#pragma once

#include <apsis/config/case_text.hpp>
#include <apsis/model/dimension.hpp>
#include <apsis/model/gas_scales.hpp>

#include <functional>
#include <optional>
#include <string>

namespace apsis {

/// Returns the dimension of a key by its path; nothing for a key that takes text.
using dimension_lookup = std::function<std::optional<dimension>(const std::string& path)>;

/// Replaces values of boundaries, solid boxes and bodies that are tables in time, `T = { file = "pump.csv"
/// }`, by formulas table(t, …) (formula_table.hpp), so that the numbers of the file belong to the case. The
/// file has a column `t` and one with the name of the variable, or with the names in the key `column`. A
/// header "p [Pa]" has a unit; other numbers are dimensionless. Throws input_error at the place of the key,
/// with line and column of the file: no such file or column, a number that is not finite, times that do not
/// increase, or a unit without scales or of another dimension.
void read_tables_in_time(case_text& text, const dimension_lookup& dimension_of,
                         const std::optional<gas_scales>& scales);

}  // namespace apsis
