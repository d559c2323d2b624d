#pragma once

#include <apsis/velocity/position.hpp>

#include <array>

namespace apsis {

/// A point of a wall with any normal.
struct wall_point {
  std::array<double, 3> normal = {};  ///< unit vector n into the gas
  position at = {};                   ///< the point
  double t = 0.0;                     ///< the time
};

/// A boundary condition on a wall with any normal n into the gas. Dimensionless.
class oblique_wall {
 public:
  virtual ~oblique_wall() = default;

  /// Sets values[k] to the distribution that leaves the wall, for every component k with v·n > 0. `inward`:
  /// v·n of every component; `arriving`: the distribution at the wall, of components with v·n < 0, ≥ 0 if
  /// that is promised. Other components of values[], which does not overlap arriving[], are free for scratch.
  /// Called concurrently. Throws input_error for impossible values of the wall.
  virtual void emit(const wall_point& where, const double* inward, const double* arriving,
                    double* values) const = 0;
  /// Returns the velocity of the wall along itself at a point.
  virtual std::array<double, 3> velocity(const wall_point& where) const = 0;
};

}  // namespace apsis
