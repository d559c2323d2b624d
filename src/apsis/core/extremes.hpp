#pragma once

#include <cmath>
#include <initializer_list>
#include <limits>
#include <span>

namespace apsis {

/// Returns the maximum; NaN if either argument is NaN (`maximum` of IEEE 754-2019). std::max ignores a NaN in
/// its second argument, so that the maximum of many errors would look small although one of them is NaN.
inline double maximum(double a, double b) {
  return std::isnan(a) || b <= a ? a : b;
}

/// Returns the minimum; NaN if either argument is NaN.
inline double minimum(double a, double b) {
  return std::isnan(a) || b >= a ? a : b;
}

/// Returns the maximum of a range; NaN if any value is NaN, −∞ for an empty range.
inline double maximum(std::span<const double> values) {
  double largest = -std::numeric_limits<double>::infinity();
  for (const double value : values) largest = maximum(largest, value);
  return largest;
}
/// Returns the maximum of a braced list; NaN if any value is NaN.
inline double maximum(std::initializer_list<double> values) {
  return maximum(std::span(values.begin(), values.size()));
}

}  // namespace apsis
