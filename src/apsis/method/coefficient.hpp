#pragma once

#include <apsis/method/precision.hpp>

#include <string>

namespace apsis {

/// Whether a string is a valid coefficient: an exact rational "p/q" or a decimal such as "-0.25" or "1.5e-3",
/// of at most 200 characters.
bool is_coefficient(const std::string& text);

/// Returns the value of a valid coefficient to the precision of mp_real.
mp_real coefficient_value(const std::string& text);

/// Returns −x of a valid coefficient, with the same digits.
std::string negated(const std::string& text);

/// Returns a computed coefficient as text: the rational p/q with q ≤ 10⁶ that it equals to 50 decimals, or
/// else a decimal with so many decimals.
std::string coefficient_text(const mp_real& x, int decimals);

/// Returns a number with 12 significant digits, for messages.
std::string short_text(const mp_real& x);

/// Returns the number of decimals of `text` if there are 12 or more; they bound the accuracy of the order
/// conditions. Returns 0 for rationals and shorter decimals, which count as exact.
int decimals(const std::string& text);

/// Returns the largest admissible residual of an equation in coefficients with this number of decimals: 1000
/// units of the last decimal, or 1e-50 for exact coefficients (0 decimals).
mp_real residual_tolerance(int decimals);

}  // namespace apsis
