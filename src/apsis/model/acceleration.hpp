#pragma once

#include <apsis/velocity/position.hpp>

#include <array>
#include <functional>

namespace apsis {

/// An acceleration a(t, x) of all molecules, with bounds on its components. Dimensionless.
struct acceleration {
  /// Returns a at a time and a point of space. Components beyond the directions of the velocities
  /// are ignored.
  std::function<std::array<double, 3>(double t, const position& x)> value;
  /// |a_k| is at most largest[k] at all times and points.
  std::array<double, 3> largest{};
};

struct velocity_lattice;

/// Throws input_error unless the velocities along each direction of the acceleration are at least five with
/// equal distances. The message begins with the key of a case that must change.
void check_velocities(const acceleration& of, const velocity_lattice& lattice);

}  // namespace apsis
