#pragma once

#include <apsis/model/expression.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Returns the numbers of each text, such as "1, 0" or "cos(pi/3), sin(pi/3)": formulas of `constants`,
/// separated by commas. Throws input_error if a formula is invalid or not finite.
std::vector<std::vector<double>> number_tuples(const std::vector<std::string>& texts,
                                               const formula_constants& constants);

}  // namespace apsis
