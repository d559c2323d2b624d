#pragma once

#include <apsis/run/setup.hpp>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace apsis {

/// Computes the torques on solid boxes and bodies about the origin, from the momentum that the gas receives
/// at the ends of this process.
class torque_sum {
 public:
  explicit torque_sum(const run_setup& setup);

  /// Returns −Σ (x × p + m p·n) over the ends of each of loaded_bodies(). Here p is the momentum of a
  /// boundary_budget that the gas received at an end, n the normal and m = wall_segment::moment. The result
  /// is [body] in the plane (component along z) and in axisymmetric flow (component along the axis), and
  /// [body][component] in space. Sums are exact and rounded once. Collective.
  std::vector<double> of(std::span<const double> amounts) const;

 private:
  struct arm {
    std::size_t body, first;  ///< index of the body, and of the first amount of the end
    position x;
    std::array<double, 3> normal, moment;  ///< of a wall_segment; 0 at the face of a cell
  };
  const run_setup& setup_;
  std::vector<std::size_t> momenta_;
  std::size_t bodies_ = 0;
  std::vector<arm> arms_;
};

}  // namespace apsis
