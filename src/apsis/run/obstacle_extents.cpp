#include <apsis/run/obstacle_extents.hpp>

#include <apsis/core/index.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/mesh/face.hpp>

#include <utility>

namespace apsis {
namespace {

class obstacle_measure {
 public:
  explicit obstacle_measure(const grid& mesh) : mesh_(mesh) {
    found_.obstacles.resize(at(mesh.obstacles()));
    if (mesh.cut() != nullptr) look_at_cut_cells(*mesh.cut());
    for (int cell = 0; cell < mesh.size(); ++cell) add(cell);
  }

  obstacle_extents found() && { return std::move(found_); }

 private:
  /// Finds the body of each cut cell, and its open areas at faces of the domain.
  void look_at_cut_cells(const cut_cells& cut) {
    of_cut_cell_.assign(at(mesh_.size()), -1);
    open_.resize(at(mesh_.size()));
    const int boxes = static_cast<int>(mesh_.solids().size());
    for (const wall_segment& wall : cut.walls())
      if (wall.solid >= boxes) of_cut_cell_[at(wall.cell)] = wall.solid;
    for (const open_face& one : cut.faces()) {
      if (one.below >= 0 && one.above >= 0) continue;
      const bool upper = one.above < 0;
      open_[at(upper ? one.below : one.above)][face{one.direction, upper}.index()] += one.area;
    }
  }

  void add(int cell) {
    const bool is_cut = mesh_.cut_group(cell) >= 0;
    const int obstacle = is_cut ? of_cut_cell_[at(cell)] : mesh_.solid(cell);
    if (obstacle >= 0) found_.obstacles[at(obstacle)].cells += is_cut ? 1.0 - mesh_.gas_share(cell) : 1.0;
    for (int k = 0; k < mesh_.dimensions(); ++k) {
      const int place = cell / mesh_.stride(k) % mesh_.cells(k);
      if (place == 0) look_at_face(cell, obstacle, is_cut, {k, false});
      if (place == mesh_.cells(k) - 1) look_at_face(cell, obstacle, is_cut, {k, true});
    }
  }

  void look_at_face(int cell, int obstacle, bool is_cut, const face& where) {
    constexpr double all = 1.0 - 1e-9;  // the open part of a whole face, to rounding
    const bool is_gas = mesh_.solid(cell) < 0;
    if (is_gas) found_.has_gas[where.index()] = true;
    const bool closed = is_cut ? open_[at(cell)][where.index()] < all * mesh_.face_area(where) : !is_gas;
    if (obstacle >= 0 && closed) found_.obstacles[at(obstacle)].touches[where.index()] = true;
  }

  const grid& mesh_;
  obstacle_extents found_;
  std::vector<int> of_cut_cell_;  ///< body whose wall bounds the gas of a cut cell; -1 for others
  std::vector<std::array<double, 6>> open_;
};

}  // namespace

obstacle_extents measure_obstacles(const grid& mesh) {
  return obstacle_measure(mesh).found();
}

}  // namespace apsis
