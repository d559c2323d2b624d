#include <apsis/mesh/cut_cells.hpp>

#include <apsis/mesh/internal/mesh_cutter.hpp>

namespace apsis {

cut_cells::cut_cells(const grid& mesh, const std::vector<outside_function>& bodies,
                     const std::array<bool, 3>& periodic)
    : mesh_(mesh), bodies_(static_cast<int>(bodies.size())) {
  mesh_cutter(mesh, bodies, periodic, *this).cut();
}

double cut_cells::volume_of(int cell) const {
  return volumes_.at(cell);
}

bool has_unknown(const grid& mesh, int cell) {
  const int group = mesh.cut_group(cell);
  return mesh.solid(cell) < 0 && (group < 0 || mesh.cut()->groups()[at(group)].cells.front() == cell);
}

}  // namespace apsis
