#pragma once

#include <apsis/mesh/grid.hpp>

#include <array>
#include <vector>

namespace apsis {

/// Cells of the gas in an order of elimination with little fill.
struct dissected_mesh {
  std::vector<int> cells;  ///< in the order of elimination
  std::vector<int> parts;  ///< numbers of cells that are eliminated together, in order
};

/// Orders cells by nested dissection of the mesh (George, SIAM J. Numer. Anal. 10, 1973). The equation of a
/// cell contains cells at a distance of at most `reach`. Slabs of `reach` cells separate the halves and
/// follow them. `periodic` is given for each direction.
dissected_mesh dissect(const grid& mesh, const std::array<bool, 3>& periodic, int reach);

}  // namespace apsis
