#pragma once

#include <apsis/mesh/grid.hpp>

#include <array>
#include <vector>

namespace apsis {

/// The cells of a solid box or body: how many it fills, and the faces of the domain that it touches.
struct obstacle_extent {
  double cells = 0.0;                ///< volume in cells
  std::array<bool, 6> touches = {};  ///< by face::index()
};

/// The solid boxes and bodies of a mesh.
struct obstacle_extents {
  std::vector<obstacle_extent> obstacles;  ///< in the order of grid::solid(): boxes first
  std::array<bool, 6> has_gas = {};        ///< whether some cell at a face has gas, by face::index()
};

/// Measures the solid boxes and bodies of a whole mesh. A cut cell belongs to the body of its last wall. At a
/// periodic face, which has no open area of its own, every body in a cut cell counts as touching.
obstacle_extents measure_obstacles(const grid& mesh);

}  // namespace apsis
