#pragma once

#include <apsis/method/method.hpp>

#include <string>

namespace apsis {

/// Returns the method file of `m`: parse_method() restores every coefficient exactly.
std::string to_toml(const method& m);

/// Returns the method as a LaTeX display: the Shu–Osher matrices (or the tableau A of a method without a
/// Shu–Osher form), exact rationals as fractions and decimals with `digits` significant digits, followed by
/// the embedded row, if there is one.
std::string to_latex(const method& m, int digits = 15);

}  // namespace apsis
