#pragma once

#include <apsis/velocity/velocity_line.hpp>

#include <string>
#include <utility>
#include <vector>

namespace apsis {

/// How a kinetic model computes its discrete equilibrium.
enum class equilibrium_choice {
  automatic,  ///< `formula` on uniform lines if its discrete moments are exact, else `discrete`
  formula,    ///< the Maxwellian at the grid points
  discrete    ///< the minimizer of the entropy with the discrete moments
};

/// Numbers of velocities: one for all directions, or one for each direction.
class point_counts {
 public:
  /// One number for all directions.
  point_counts(int all = 0) : of_({all}) {}  // NOLINT(google-explicit-constructor)
  /// One number for each direction.
  point_counts(std::vector<int> each) : of_(std::move(each)) {}  // NOLINT(google-explicit-constructor)
  /// Returns the first number.
  operator int() const { return of_.empty() ? 0 : of_.front(); }  // NOLINT(google-explicit-constructor)
  const std::vector<int>& each() const { return of_; }            ///< one number, or one per direction
  bool operator==(const point_counts&) const = default;           ///< equal numbers
  bool operator==(int all) const { return of_ == std::vector<int>{all}; }  ///< this one number

 private:
  std::vector<int> of_;
};

/// Velocity grid of a kinetic model.
struct velocity_config {
  double max = 0.0;         ///< largest |v| (dimensionless); 0 if the set determines it
  point_counts points = 0;  ///< at least 4; 0 if the set determines it
  equilibrium_choice equilibrium = equilibrium_choice::automatic;  ///< computation of the equilibrium
  /// Names of velocity lines or files (velocity_line_registry.hpp): one for all directions, or one for each
  /// direction. Empty stands for "uniform".
  std::vector<std::string> set = {};
  /// Number of rings about an axis of symmetry; 0 without an axis. The members above then describe the
  /// velocities along the axis.
  int rings = 0;
  int angles = 0;           ///< velocities of every ring
  double max_across = 0.0;  ///< largest v_⊥ of rings; 0: the largest velocity along the axis
  /// Lines of velocities that replace `max`, `points` and `set`: one for all directions, or one for
  /// each direction.
  std::vector<velocity_line> lines = {};
  bool operator==(const velocity_config&) const = default;  ///< equal values
};

}  // namespace apsis
