#include <apsis/mesh/cut_cells.hpp>

#include <apsis/mesh/internal/mesh_cutter.hpp>

namespace apsis {

cut_cells::cut_cells(const grid& mesh, const std::vector<outside_function>& bodies,
                     const std::array<bool, 3>& periodic, double cfl_number) {
  mesh_cutter(mesh, bodies, periodic, cfl_number, *this).cut();
}

double cut_cells::volume_of(int cell) const {
  return volumes_.at(cell);
}

}  // namespace apsis
