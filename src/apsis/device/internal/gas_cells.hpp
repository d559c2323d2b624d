#pragma once

#include <apsis/mesh/grid.hpp>

#include <vector>

namespace apsis {

/// Returns the ranges of cells of a mesh that contain gas.
inline std::vector<cell_range> gas_cells(const grid& mesh) {
  if (mesh.fluid().empty()) return {{0, mesh.size()}};
  return mesh.fluid();
}

}  // namespace apsis
