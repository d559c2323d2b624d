#pragma once

#include <apsis/boundary/boundary.hpp>

#include <vector>

namespace apsis {

/// The border between whole cells and cut cells. The transport takes the entering values from the cut cells.
/// Ghost rows continue the state inside: by a parabola for components that leave, by a straight line for
/// those that enter. A parabola through cells downstream would make the edge value behind the first cell a
/// downwind value. Along a border at 45° to the grid, modes that alternate from cell to cell would then grow
/// at a rate of 0.13 |v|/Δx.
class border_of_cut_cells final : public boundary {
 public:
  /// `where` is the side of the whole cells on which the border lies.
  border_of_cut_cells(const face& where, const velocity_set& velocities)
      : inward_(inward_speeds(where, velocities)) {}

  bool prescribes_incoming(int, int) const override { return true; }
  void fill(const face& where, double t, const pencil_end& rows) const override;

 private:
  std::vector<double> inward_;
};

}  // namespace apsis
