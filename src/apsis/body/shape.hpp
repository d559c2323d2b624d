#pragma once

#include <apsis/velocity/position.hpp>

namespace apsis {

/// A body in space as a function φ: the body is the closed set φ ≤ 0, the gas is where φ > 0.
class shape {
 public:
  shape() = default;
  shape(const shape&) = delete;
  shape& operator=(const shape&) = delete;
  virtual ~shape() = default;

  /// Returns φ(x), which is continuous (dimensionless, in units of length of the case). |φ| is the distance
  /// of x from the surface, or approximates it near the surface to first order. May be called concurrently.
  /// Throws input_error if φ is a formula without a finite value at x.
  virtual double outside(const position& x) const = 0;
};

}  // namespace apsis
