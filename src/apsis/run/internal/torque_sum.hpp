#pragma once

#include <apsis/run/setup.hpp>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace apsis {

/// Torques on solid boxes and bodies about the origin, from what the gas receives at the ends of this
/// process.
class torque_sum {
 public:
  explicit torque_sum(const run_setup& setup);

  /// Returns −Σ (x × p + m p·n) over the ends of each of loaded_bodies(), with the momentum p of a
  /// boundary_budget that the gas received there, the normal n and wall_segment::moment m: [body], the
  /// component along z in the plane and along an axis of symmetry, [body][component] in space. Sums are exact
  /// before they are rounded. Collective.
  std::vector<double> of(std::span<const double> amounts) const;

 private:
  struct arm {
    std::size_t body, first;  ///< its number, and that of the first amount of the end
    position x;
    std::array<double, 3> normal, moment;  ///< of a wall_segment; 0 at the face of a cell
  };
  const run_setup& setup_;
  std::vector<std::size_t> momenta_;
  std::size_t bodies_ = 0;
  std::vector<arm> arms_;
};

}  // namespace apsis
