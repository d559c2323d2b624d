#include <apsis/run/body_warnings.hpp>

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/core/index.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/mesh/face.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

/// With 2.7 cells across, the heat of gas/cylinder is 38 % larger than with 16, and the drag the same to 1 %.
constexpr double least_cells_across = 3.0, good_cells_across = 4.0;

/// The cells of a body: how many it fills, and the faces of the domain that it touches.
struct extent {
  double cells = 0.0;                ///< volume in cells
  std::array<bool, 6> touches = {};  ///< by face::index()
};

/// Measures the bodies in the cells of a mesh.
class body_extents {
 public:
  explicit body_extents(const grid& mesh)
      : mesh_(mesh), cut_(*mesh.cut()), bodies_(at(cut_.bodies())), of_cut_cell_(at(mesh.size()), -1) {
    const int boxes = static_cast<int>(mesh.solids().size());
    for (const wall_segment& wall : cut_.walls())
      if (wall.solid >= boxes) of_cut_cell_[at(wall.cell)] = wall.solid - boxes;
    find_open_areas();
    for (int cell = 0; cell < mesh.size(); ++cell) add(cell);
  }

  const std::vector<extent>& bodies() const { return bodies_; }
  bool has_gas_at(std::size_t face) const { return gas_at_[face]; }

 private:
  /// Adds up the open areas of cut cells at faces of the domain.
  void find_open_areas() {
    open_.resize(at(mesh_.size()));
    for (const open_face& one : cut_.faces()) {
      if (one.below >= 0 && one.above >= 0) continue;
      const bool upper = one.above < 0;
      const int cell = upper ? one.below : one.above;
      open_[at(cell)][face{one.direction, upper}.index()] += one.area;
    }
  }

  void add(int cell) {
    const bool is_cut = cut_.group_of(cell) >= 0;
    const int body = is_cut ? of_cut_cell_[at(cell)] : cut_.body_of(cell);
    if (body >= 0) bodies_[at(body)].cells += is_cut ? 1.0 - mesh_.gas_share(cell) : 1.0;
    for (int k = 0; k < mesh_.dimensions(); ++k) {
      const int place = cell / mesh_.stride(k) % mesh_.cells(k);
      if (place == 0) look_at_face(cell, body, is_cut, {k, false});
      if (place == mesh_.cells(k) - 1) look_at_face(cell, body, is_cut, {k, true});
    }
  }

  void look_at_face(int cell, int body, bool is_cut, const face& where) {
    constexpr double all = 1.0 - 1e-9;  // the open part of a whole face, to rounding
    const bool is_gas = mesh_.solid(cell) < 0;
    gas_at_[where.index()] = gas_at_[where.index()] || is_gas;
    const bool closed = is_cut ? open_[at(cell)][where.index()] < all * mesh_.face_area(where) : !is_gas;
    if (body >= 0 && closed) bodies_[at(body)].touches[where.index()] = true;
  }

  const grid& mesh_;
  const cut_cells& cut_;
  std::vector<extent> bodies_;
  std::vector<int> of_cut_cell_;  ///< body whose wall bounds the gas of a cut cell; -1 for others
  std::vector<std::array<double, 6>> open_;
  std::array<bool, 6> gas_at_ = {};
};

std::string thin_cells_warning(int cells) {
  return fmt::format(
      "edges or thin parts of bodies are cut off in {} (they end between the corners of a cell); "
      "increase space.cells to lose less",
      cells == 1 ? "1 cell" : fmt::format("{} cells", cells));
}

std::string small_body_warning(const std::string& name, const extent& body, const grid& mesh) {
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
std::size_t cutting_face(const case_config& config, const body_extents& all, const extent& body) {
  std::vector<std::size_t> touched;
  for (std::size_t face = 0; face < face_names.size(); ++face)
    if (body.touches[face] && kind_of(config, face) != "periodic") touched.push_back(face);
  const auto cuts = [&](std::size_t face) { return is_open(config, face) && all.has_gas_at(face); };
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
  const body_extents all(mesh);
  for (std::size_t k = 0; k < all.bodies().size(); ++k) {
    const extent& body = all.bodies()[k];
    const std::string& name = config.bodies[k].name;
    if (body.cells < std::pow(least_cells_across, mesh.dimensions()))
      warnings.push_back(small_body_warning(name, body, mesh));
    if (const std::size_t face = cutting_face(config, all, body); face < face_names.size())
      warnings.push_back(cut_body_warning(name, face_names[face]));
  }
  return warnings;
}

}  // namespace apsis
