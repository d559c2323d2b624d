#pragma once

#include <array>
#include <cstddef>

namespace apsis {

/// A number with its derivatives in eight directions (forward-mode differentiation). One pass of an algorithm
/// over `tangent` gives exact derivatives in eight unknowns. One pass of a gradient gives eight columns of
/// the Hessian.
struct tangent {
  static constexpr std::size_t width = 8;  ///< number of directions
  double value = 0.0;                      ///< the number itself
  std::array<double, width> slope{};       ///< its derivative in each direction

  tangent() = default;
  /// Constant with zero derivatives.
  tangent(double v) : value(v) {}  // NOLINT(google-explicit-constructor): a constant is a number

  /// @cond
  tangent& operator+=(const tangent& b) {
    value += b.value;
    for (std::size_t k = 0; k < width; ++k) slope[k] += b.slope[k];
    return *this;
  }
  tangent& operator-=(const tangent& b) {
    value -= b.value;
    for (std::size_t k = 0; k < width; ++k) slope[k] -= b.slope[k];
    return *this;
  }
  tangent& operator*=(const tangent& b) {
    for (std::size_t k = 0; k < width; ++k) slope[k] = slope[k] * b.value + value * b.slope[k];
    value *= b.value;
    return *this;
  }
  tangent& operator/=(const tangent& b) {
    value /= b.value;
    for (std::size_t k = 0; k < width; ++k) slope[k] = (slope[k] - value * b.slope[k]) / b.value;
    return *this;
  }
  friend tangent operator+(tangent a, const tangent& b) { return a += b; }
  friend tangent operator-(tangent a, const tangent& b) { return a -= b; }
  friend tangent operator*(tangent a, const tangent& b) { return a *= b; }
  friend tangent operator/(tangent a, const tangent& b) { return a /= b; }
  friend tangent operator-(const tangent& a) { return tangent(0.0) - a; }
  /// @endcond
};

}  // namespace apsis
