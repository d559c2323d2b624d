#pragma once

#include <cmath>
#include <initializer_list>
#include <limits>
#include <span>

namespace apsis {

/// The larger number, or NaN if one is NaN (`maximum` of IEEE 754-2019). std::max drops a NaN that comes
/// second, so that the largest of many errors would look good when one of them is no number.
inline double maximum(double a, double b) {
  return std::isnan(a) || b <= a ? a : b;
}

/// The smaller number, or NaN if one is NaN.
inline double minimum(double a, double b) {
  return std::isnan(a) || b >= a ? a : b;
}

/// The largest, or NaN if one is NaN; −∞ of no numbers.
inline double maximum(std::span<const double> values) {
  double largest = -std::numeric_limits<double>::infinity();
  for (const double value : values) largest = maximum(largest, value);
  return largest;
}
/// The same of numbers in braces.
inline double maximum(std::initializer_list<double> values) {
  return maximum(std::span(values.begin(), values.size()));
}

}  // namespace apsis
