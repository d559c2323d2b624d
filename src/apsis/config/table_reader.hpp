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

/// Replaces values that are tables in time, `T = { file = "pump.csv" }`, by formulas table(t, …)
/// (formula_table.hpp). The numbers of the file then belong to the case. Boundaries, solid boxes and bodies
/// may have such values.
///
/// The file has a column `t` and one with the name of the variable, or with the names in the key `column`.
/// Numbers below a header "p [Pa]" have its unit; others are dimensionless.
///
/// Throws input_error at the place of the key, with line and column of the file, if there is no such
/// file or column. Also throws it if a number is not finite, times do not increase, or a unit has no
/// scales or another dimension.
void read_tables_in_time(case_text& text, const dimension_lookup& dimension_of,
                         const std::optional<gas_scales>& scales);

}  // namespace apsis
