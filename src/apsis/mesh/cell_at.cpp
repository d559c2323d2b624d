#include <apsis/mesh/cell_at.hpp>

#include <algorithm>
#include <cmath>

namespace apsis {

int cell_at(const grid& mesh, std::span<const double> x) {
  int cell = 0;
  for (int k = 0; k < mesh.dimensions(); ++k) {
    const double i = std::floor((x[static_cast<std::size_t>(k)] - mesh.centre(0, k)) / mesh.spacing(k) + 0.5);
    cell += mesh.stride(k) * static_cast<int>(std::clamp(i, 0.0, mesh.cells(k) - 1.0));
  }
  return cell;
}

}  // namespace apsis
