#pragma once

#include <apsis/mesh/grid.hpp>

#include <array>
#include <vector>

namespace apsis {

/// Cells of the gas in an order of elimination with little fill.
struct dissected_mesh {
  std::vector<int> cells;  ///< in order
  std::vector<int> parts;  ///< numbers of cells that are eliminated together, one after the other
};

/// Orders cells by nested dissection of the mesh (George, SIAM J. Numer. Anal. 10, 1973). Slabs of `reach`
/// cells, which is how far the equation of a cell reaches, separate the halves and follow them. `periodic`:
/// of each direction.
dissected_mesh dissect(const grid& mesh, const std::array<bool, 3>& periodic, int reach);

}  // namespace apsis
