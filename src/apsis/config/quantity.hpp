#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/model/dimension.hpp>

#include <string>

namespace apsis {

/// A number with a unit: "10 Pa", "350 K", "1e20 1/m^3".
struct quantity {
  double value = 0.0;   ///< in unit_of(unit)
  dimension unit = {};  ///< physical dimension
};

/// Returns whether a text is a number, spaces, and the beginning of a unit, not of an operator. A percentage
/// counts too, so that parse_quantity() refuses it.
bool looks_like_quantity(const std::string& text);

/// Returns "350 K" for "350K"; "" if the text is not a number followed by a unit.
std::string with_missing_space(const std::string& text);

/// Returns the quantity of a text. Units are products and quotients of powers of m, g, s, K, Pa, bar, atm,
/// Torr, N, J, W and u (the atomic mass unit). Prefixes such as k, m, u or µ are allowed; "degC" stands
/// alone. Throws input_error at `place` if the text is not a number with a unit, the unit is unknown, or the
/// value is not finite.
quantity parse_quantity(const std::string& text, const source_place& place);

}  // namespace apsis
