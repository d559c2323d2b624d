#pragma once

#include <cmath>
#include <initializer_list>
#include <limits>
#include <span>

namespace apsis {

/// Maximum; NaN if either argument is NaN (`maximum` of IEEE 754-2019). std::max drops a NaN in its second
/// argument, so that the maximum of many errors would look small when one of them is NaN.
inline double maximum(double a, double b) {
  return std::isnan(a) || b <= a ? a : b;
}

/// Minimum; NaN if either argument is NaN.
inline double minimum(double a, double b) {
  return std::isnan(a) || b >= a ? a : b;
}

/// Maximum of a range; NaN if any value is NaN, −∞ for an empty range.
inline double maximum(std::span<const double> values) {
  double largest = -std::numeric_limits<double>::infinity();
  for (const double value : values) largest = maximum(largest, value);
  return largest;
}
/// Maximum of a braced list.
inline double maximum(std::initializer_list<double> values) {
  return maximum(std::span(values.begin(), values.size()));
}

}  // namespace apsis
