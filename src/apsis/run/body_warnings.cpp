#include <apsis/run/body_warnings.hpp>

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/mesh/face.hpp>
#include <apsis/run/obstacle_extents.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

/// With 2.7 cells across, the heat of gas/cylinder is 38 % larger than with 16, and the drag the same to 1 %.
constexpr double least_cells_across = 3.0, good_cells_across = 4.0;

std::string thin_cells_warning(int cells) {
  return fmt::format(
      "edges or thin parts of bodies are cut off in {} (they end between the corners of a cell); "
      "increase space.cells to lose less",
      cells == 1 ? "1 cell" : fmt::format("{} cells", cells));
}

std::string small_body_warning(const std::string& name, const obstacle_extent& body, const grid& mesh) {
  const double across = std::pow(body.cells, 1.0 / mesh.dimensions());
  std::vector<long> cells;
  for (int k = 0; k < mesh.dimensions(); ++k)
    cells.push_back(static_cast<long>(std::ceil(mesh.cells(k) * good_cells_across / across)));
  return fmt::format(
      "body '{}' is only {:.2g} cells across (its heat and shear are inaccurate below {:g}); give about "
      "space.cells = [{}] for {:g} cells",
      name, across, least_cells_across, fmt::join(cells, ", "), good_cells_across);
}

const std::string& kind_of(const case_config& config, std::size_t face) {
  return config.faces[face].kind ? *config.faces[face].kind : config.space.boundary;
}

/// Returns whether gas passes through a face of the domain.
bool is_open(const case_config& config, std::size_t face) {
  const std::string& kind = kind_of(config, face);
  const bool is_wall = find_boundary(kind).any_normal && kind != "vacuum";
  return !is_wall && kind != "periodic" && kind != "axis";
}

/// Returns the first face whose open end cuts a body; face_names.size() without one.
std::size_t cutting_face(const case_config& config, const obstacle_extents& all,
                         const obstacle_extent& body) {
  std::vector<std::size_t> touched;
  for (std::size_t face = 0; face < face_names.size(); ++face)
    if (body.touches[face] && kind_of(config, face) != "periodic") touched.push_back(face);
  const auto cuts = [&](std::size_t face) { return is_open(config, face) && all.has_gas[face]; };
  const bool is_cut = !touched.empty() && std::all_of(touched.begin(), touched.end(), cuts);
  return is_cut && (touched.size() == 1 || config.output.reference) ? touched.front() : face_names.size();
}

std::string cut_body_warning(const std::string& name, const std::string& face) {
  return fmt::format(
      "body '{}' is cut by the open end [boundary.{}] (its wall ends there, and its loads are those of the "
      "part inside); extend space.domain, or write kind = \"symmetry\" there for half of a body",
      name, face);
}

}  // namespace

std::vector<std::string> warnings_of_bodies(const case_config& config, const grid& mesh) {
  std::vector<std::string> warnings;
  if (mesh.cut() == nullptr) return warnings;
  if (const int thin = mesh.cut()->thin_cells(); thin > 0) warnings.push_back(thin_cells_warning(thin));
  const obstacle_extents all = measure_obstacles(mesh);
  for (std::size_t k = 0; k < config.bodies.size(); ++k) {
    const obstacle_extent& body = all.obstacles[mesh.solids().size() + k];
    const std::string& name = config.bodies[k].name;
    if (body.cells < std::pow(least_cells_across, mesh.dimensions()))
      warnings.push_back(small_body_warning(name, body, mesh));
    if (const std::size_t face = cutting_face(config, all, body); face < face_names.size())
      warnings.push_back(cut_body_warning(name, face_names[face]));
  }
  return warnings;
}

}  // namespace apsis
