#include <apsis/output/mesh_axis.hpp>

namespace apsis {

std::vector<mesh_axis> mesh_axes(const grid& mesh) {
  std::vector<mesh_axis> axes;
  for (int k = 0; k < mesh.dimensions(); ++k) {
    mesh_axis axis{std::string(1, "xyz"[k]), {}};
    for (int i = 0; i < mesh.cells(k); ++i) axis.centres.push_back(mesh.centre(i * mesh.stride(k), k));
    axes.push_back(std::move(axis));
  }
  return axes;
}

std::vector<std::uint64_t> mesh_shape(const std::vector<mesh_axis>& axes) {
  if (axes.empty()) return {1};
  std::vector<std::uint64_t> shape;
  for (const auto& axis : axes) shape.push_back(axis.centres.size());
  return shape;
}

std::size_t mesh_size(const std::vector<mesh_axis>& axes) {
  std::size_t cells = 1;
  for (const auto& axis : axes) cells *= axis.centres.size();
  return cells;
}

double centre_of_cell(const std::vector<mesh_axis>& axes, std::size_t cell, std::size_t k) {
  std::size_t stride = 1;
  for (std::size_t l = k + 1; l < axes.size(); ++l) stride *= axes[l].centres.size();
  return axes[k].centres[cell / stride % axes[k].centres.size()];
}

}  // namespace apsis
