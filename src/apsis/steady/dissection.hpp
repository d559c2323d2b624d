#pragma once

#include <apsis/mesh/grid.hpp>

#include <array>
#include <vector>

namespace apsis {

/// Returns the cells of the gas in an order of elimination with little fill: nested dissection of the mesh
/// (George, SIAM J. Numer. Anal. 10, 1973). Slabs of two cells, which is how far fluxes reach, separate the
/// halves and follow them. `periodic`: of each direction.
std::vector<int> dissected_cells(const grid& mesh, const std::array<bool, 3>& periodic);

}  // namespace apsis
