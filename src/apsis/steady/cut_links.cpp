#include <apsis/steady/cut_links.hpp>

#include <apsis/core/index.hpp>

#include <algorithm>
#include <cstddef>
#include <span>

namespace apsis {
namespace {

/// Whether two cells are neighbours within the mesh, and not across a periodic face.
bool are_neighbours(const grid& mesh, int below, int above, int direction) {
  const int stride = mesh.stride(direction), cells = mesh.cells(direction);
  return above / stride % cells == below / stride % cells + 1;
}

}  // namespace

cut_links::cut_links(const domain& space) {
  if (space.mesh().cut() == nullptr) return;
  const cut_cells& cut = *space.mesh().cut();
  group_of_.assign(at(space.mesh().size()), -1);
  for (int solid = 0; solid < space.mesh().obstacles(); ++solid)
    walls_.push_back(space.solid_boundary(solid)->oblique(space.space().velocities));
  for (std::size_t number = 0; number < cut.groups().size(); ++number) {
    const cut_group& of = cut.groups()[number];
    group_of_cut& made = groups_.emplace_back();
    made.cell = of.cells.front();
    made.others.assign(of.cells.begin() + 1, of.cells.end());
    made.volume = of.volume / space.mesh().cell_volume();
    for (const int cell : of.cells) group_of_[at(cell)] = static_cast<int>(number);
    for (const int f : of.faces) made.ways.push_back(way_through(space, static_cast<int>(number), f));
    for (const int w : of.walls) {
      const wall_segment& one = cut.walls()[at(w)];
      way_out_of_cut& way = made.ways.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) way.normal[k] = -one.normal[k];
      way.rate = one.area / of.volume;
      way.from_centre = one.from_centre;
      way.wall = walls_[at(one.solid)].get();
      way.at = {one.normal, one.middle, 0.0};
    }
  }
  // Groups behind the faces of others are known now.
  for (group_of_cut& of : groups_)
    for (way_out_of_cut& way : of.ways)
      if (way.other >= 0) way.other = first_of(way.other);
}

way_out_of_cut cut_links::way_through(const domain& space, int group, int number) const {
  const cut_cells& cut = *space.mesh().cut();
  const open_face& one = cut.faces()[at(number)];
  const bool is_below = one.below >= 0 && cut.group_of(one.below) == group;
  way_out_of_cut way;
  way.other = is_below ? one.above : one.below;
  way.normal[at(one.direction)] = is_below ? 1.0 : -1.0;
  way.rate = one.area / cut.groups()[at(group)].volume;
  way.from_centre = is_below ? one.from_below : one.from_above;
  way.face = number;
  if (way.other >= 0) {
    way.is_image = !are_neighbours(space.mesh(), one.below, one.above, one.direction);
    return way;
  }
  const face where{one.direction, is_below};
  const boundary* side = space.side(static_cast<int>(where.index()));
  const int cell = is_below ? one.below : one.above;
  way.end = gas_end_of_segment{where, side, one.middle, {cell, cell, cell}, side->cell_of_ghost(0, 1) == 0};
  return way;
}

void cut_links::copy_rows(field& u) const {
  for (const group_of_cut& of : groups_)
    for (const int cell : of.others) std::copy_n(u.row(of.cell), u.stride(), u.row(cell));
}

wall_response::wall_response(const velocity_set& velocities, int stride)
    : velocities_(velocities), inward_(at(stride), 0.0), emitted_(at(stride), 0.0) {}

void wall_response::values_at(const way_out_of_cut& way, const double* inside, double* row) {
  const std::size_t components = at(velocities_.components());
  std::fill(inward_.begin(), inward_.end(), 0.0);
  for (int d = 0; d < velocities_.dimensions(); ++d) {
    const std::span<const double> speeds = velocities_.speeds(d);
    for (std::size_t k = 0; k < components; ++k) inward_[k] += way.at.normal[at(d)] * speeds[k];
  }
  way.wall->emit(way.at, inward_.data(), inside, emitted_.data());
  for (std::size_t k = 0; k < components; ++k) row[k] = inward_[k] > 0.0 ? emitted_[k] : inside[k];
}

}  // namespace apsis
