#pragma once

#include <apsis/method/method.hpp>

#include <string>

namespace apsis {

/// The file of a method: parse_method() of it gives the same method, coefficient for coefficient.
std::string to_toml(const method& m);

/// The method as a LaTeX display: Shu–Osher matrices (or the tableau A of a method without one) with exact
/// rationals as fractions and decimals of `digits` significant digits; then the embedded row, if there is
/// one.
std::string to_latex(const method& m, int digits = 15);

}  // namespace apsis
