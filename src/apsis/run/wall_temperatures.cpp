#include <apsis/run/wall_temperatures.hpp>

#include <apsis/core/index.hpp>
#include <apsis/exec/global_sum.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/run/found_walls.hpp>
#include <apsis/semidiscrete/face_fluxes.hpp>

namespace apsis {

wall_temperatures::wall_temperatures(const run_setup& setup) : setup_(setup), temperature_(*setup.equation) {
  const auto walls = found_walls(setup);
  if (walls.empty()) return;
  const domain& space = setup.builder().space();
  std::size_t end = 0;
  for (std::size_t k = 0; k < space.budget_surfaces().size() && walls_ < walls.size(); ++k) {
    const budget_surface& one = space.budget_surfaces()[k];
    if (walls[walls_].face == k) add_pieces(walls_++, one, end);
    end += space.ends_at(one);
  }
}

void wall_temperatures::add_pieces(std::size_t wall, const budget_surface& one, std::size_t end) {
  const domain& space = setup_.builder().space();
  const grid& mesh = space.mesh();
  const auto add = [&](const boundary* side, const std::array<double, 3>& normal, const position& x,
                       double area) {
    pieces_.push_back({wall, end++, side, normal, x, mesh.radius(x) * area});
  };
  for (const int number : one.surfaces) {
    const surface& here = space.surfaces()[at(number)];
    for (int place = 0; place < here.own; ++place)
      add(space.side(number), here.where.inward_normal(), space.meeting_point(number, place),
          mesh.face_area(here.where));
  }
  const boundary* side = &space.boundary_at(one);
  for (const int number : one.cut_faces) {
    const open_face& part = mesh.cut()->faces()[at(number)];
    add(side, one.where.inward_normal(), part.middle, part.area);
  }
  for (const int number : one.walls) {
    const wall_segment& part = mesh.cut()->walls()[at(number)];
    add(side, part.normal, part.middle, part.area);
  }
}

std::vector<double> wall_temperatures::of(double t, std::span<const double> observed) const {
  const std::size_t count = setup_.equation->invariants().size();
  std::vector<exact_sum> sums(2 * walls_);  // of A T_w, and of A
  std::vector<double> arriving(count);
  for (const piece& one : pieces_) {
    const std::size_t first = (face_fluxes::observed_moments * one.end + 1) * count;  // after the densities
    if (first + count > observed.size()) break;
    for (std::size_t k = 0; k < count; ++k)
      arriving[k] = observed[first + k] / setup_.whole_mesh().radius(one.x);
    const auto T = temperature_.value(one.side, {one.normal, one.x, t}, arriving);
    if (!T) continue;
    sums[2 * one.wall].add(one.area * *T);
    sums[2 * one.wall + 1].add(one.area);
  }
  const std::vector<double> all = global_values(setup_.processes(), sums);
  std::vector<double> means;
  for (std::size_t wall = 0; wall < walls_; ++wall) means.push_back(all[2 * wall] / all[2 * wall + 1]);
  return means;
}

}  // namespace apsis
