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

  /// values[k] ← the distribution that leaves the wall, for every component k with v·n > 0. `inward` is v·n
  /// of every component. `arriving` is the distribution at the wall for components with v·n < 0; it is ≥ 0 if
  /// positivity is promised. Other components of values[] are free for scratch. The two arrays do not
  /// overlap. Calls are concurrent. Throws input_error for impossible values of the wall.
  virtual void emit(const wall_point& where, const double* inward, const double* arriving,
                    double* values) const = 0;
  /// Returns the velocity of the wall at a point; it lies along the wall.
  virtual std::array<double, 3> velocity(const wall_point& where) const = 0;
};

}  // namespace apsis
