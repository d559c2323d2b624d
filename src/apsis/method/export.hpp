#pragma once

#include <apsis/method/method.hpp>

#include <string>

namespace apsis {

/// Returns the method file of `m`: parse_method() restores every coefficient exactly.
std::string to_toml(const method& m);

/// Returns the method as a LaTeX display: its Shu–Osher matrices, or the tableau of a method without a
/// Shu–Osher form, and the embedded row, if there is one. Exact rationals become fractions; decimals have
/// `digits` significant digits.
std::string to_latex(const method& m, int digits = 15);

}  // namespace apsis
