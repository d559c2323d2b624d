#pragma once

namespace apsis {

/// Location and value of an extremum.
template <class Real>
struct extremum {
  Real at{},    ///< location
      value{};  ///< value of the function at this location
};

/// Returns the maximum of f in [low, high] if f is unimodal there, otherwise some local maximum: the best of
/// all values evaluated. Each of the `steps` evaluations shortens the bracket by the golden ratio, 0.618.
template <class Real, class Function>
extremum<Real> golden_section(const Function& f, Real low, Real high, int steps) {
  const Real ratio = static_cast<Real>(0.618033988749894848204586834365638118L);
  extremum<Real> left, right;
  left.at = high - ratio * (high - low);
  right.at = low + ratio * (high - low);
  left.value = f(left.at);
  right.value = f(right.at);
  for (int k = 0; k < steps; ++k) {
    if (left.value >= right.value) {
      high = right.at;
      right = left;
      left.at = high - ratio * (high - low);
      left.value = f(left.at);
    } else {
      low = left.at;
      left = right;
      right.at = low + ratio * (high - low);
      right.value = f(right.at);
    }
  }
  return left.value >= right.value ? left : right;
}

}  // namespace apsis
