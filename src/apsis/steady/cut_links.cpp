#include <apsis/steady/cut_links.hpp>

#include <apsis/core/index.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

namespace apsis {
namespace {

/// Returns true if two cells are neighbours within the mesh, not across a periodic face.
bool are_neighbours(const grid& mesh, int below, int above, int direction) {
  const int stride = mesh.stride(direction), cells = mesh.cells(direction);
  return above / stride % cells == below / stride % cells + 1;
}

/// Returns the cells of a group in the block of this process, as numbers in this block.
std::vector<int> cells_here(const domain& space, const cut_group& of) {
  std::vector<int> found;
  for (const int cell : of.cells)
    if (const int number = space.number_in_block(cell); number >= 0) found.push_back(number);
  return found;
}

/// Returns the way out of a group through one of its faces.
way_out_of_cut way_through(const domain& space, int group, int number) {
  const cut_cells& cut = *space.mesh().cut();
  const open_face& one = cut.faces()[at(number)];
  const cut_group& of = cut.groups()[at(group)];
  const bool is_below = one.below >= 0 && cut.group_of(one.below) == group;
  way_out_of_cut way;
  way.normal[at(one.direction)] = is_below ? 1.0 : -1.0;
  way.rate = one.area / of.volume;
  way.from_centre = is_below ? one.from_below : one.from_above;
  way.face = number;
  if (const int other = is_below ? one.above : one.below; other >= 0) {
    const int group_there = cut.group_of(other);
    way.other = space.number_in_block(group_there < 0 ? other : cut.groups()[at(group_there)].cells.front());
    const grid& whole = space.shared() ? space.shared_mesh()->whole : space.mesh();
    way.is_image = !are_neighbours(whole, one.below, one.above, one.direction);
    return way;
  }
  const face where{one.direction, is_below};
  const boundary* side = space.side(static_cast<int>(where.index()));
  const int cell = space.number_in_block(of.cells.front());
  way.end = gas_end_of_segment{
      where, side, one.middle, {cell, cell, cell}, side->multiple_of_cell(where, one.middle, 1)};
  return way;
}

}  // namespace

cut_links::cut_links(const domain& space) : space_(&space) {
  if (space.mesh().cut() == nullptr) return;
  group_of_.assign(at(space.mesh().size()), -1);
  for (int solid = 0; solid < space.mesh().obstacles(); ++solid)
    walls_.push_back(space.solid_boundary(solid)->oblique(space.space().velocities));
  const std::vector<cut_group>& all = space.mesh().cut()->groups();
  for (std::size_t number = 0; number < all.size(); ++number)
    if (space.number_in_block(all[number].cells.front()) >= 0) add_group(space, static_cast<int>(number));
  if (space.shared()) share_groups(space);
}

void cut_links::add_group(const domain& space, int number) {
  const cut_cells& cut = *space.mesh().cut();
  const cut_group& of = cut.groups()[at(number)];
  std::vector<int> cells = cells_here(space, of);
  for (const int cell : cells) group_of_[at(cell)] = static_cast<int>(groups_.size());
  group_of_cut& made = groups_.emplace_back();
  made.cell = cells.front();
  made.others.assign(cells.begin() + 1, cells.end());
  made.volume = of.volume / space.mesh().cell_volume();
  for (const int f : of.faces) made.ways.push_back(way_through(space, number, f));
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

/// Every process computes which process has which groups, without communication.
void cut_links::share_groups(const domain& space) {
  const distribution& shared = *space.shared_mesh();
  std::vector<shared_row> rows;
  for (const cut_group& of : space.mesh().cut()->groups()) {
    const int first = of.cells.front(), owner = shared.holder(first);
    for (const int cell : of.cells)
      if (const int holder = shared.holder(cell); holder != owner) rows.push_back({first, owner, holder});
  }
  rows_ = shared_rows(shared.processes, std::move(rows));
  for (const cut_group& of : space.mesh().cut()->groups()) {
    const int first = of.cells.front();
    std::vector<int> cells = cells_here(space, of);
    if (space.number_in_block(first) < 0 && !cells.empty())
      others_.push_back({rows_.place_of(first), std::move(cells)});
  }
}

void cut_links::copy_rows(field& u) {
  rows_.exchange(u.stride(), [&](int cell) { return u.row(space_->number_in_block(cell)); });
  for (const group_of_cut& of : groups_)
    for (const int cell : of.others) std::copy_n(u.row(of.cell), u.stride(), u.row(cell));
  for (const group_of_others& of : others_)
    for (const int cell : of.cells) std::copy_n(rows_.row(of.place), u.stride(), u.row(cell));
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
