#pragma once

#include <apsis/method/precision.hpp>

#include <string>

namespace apsis {

/// Whether a text is a coefficient: an exact rational "p/q" or a decimal "-0.25", "1.5e-3".
bool is_coefficient(const std::string& text);

/// Its value to the precision of mp_real; only for texts that are coefficients.
mp_real coefficient_value(const std::string& text);

/// Significant decimals after the point of a long decimal (12 or more), 0 for rationals and short decimals,
/// which are exact. The precision that can be expected of the order conditions.
int decimals(const std::string& text);

}  // namespace apsis
