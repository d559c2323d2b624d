#include <apsis/steady/cell_links.hpp>

#include <algorithm>

namespace apsis {

cell_links::cell_links(const domain& space) : directions_(space.mesh().dimensions()) {
  for (int cell = 0; cell < space.mesh().size(); ++cell)
    if (space.mesh().solid(cell) < 0) cells_.push_back(cell);
  for (auto* links : {&next_, &image_, &end_at_})
    for (auto& of_face : *links) of_face.assign(at(space.mesh().size()), -1);
  for (int direction = 0; direction < directions_; ++direction) link(space, direction);
}

void cell_links::link(const domain& space, int direction) {
  const int apart = space.mesh().stride(direction);
  for (const segment& one : space.segments().along(direction)) {
    for (int i = 0; i + 1 < one.cells; ++i) {
      const int cell = one.first + i * apart;
      next_[index(direction, true)][at(cell)] = image_[index(direction, true)][at(cell)] = cell + apart;
      next_[index(direction, false)][at(cell + apart)] = image_[index(direction, false)][at(cell + apart)] =
          cell;
    }
    for (const bool upper : {false, true}) {
      if (!one.ends_here(upper)) continue;
      const segment_end& end = one.ends[upper ? 1 : 0];
      if (end.surface >= 0) {
        add_end(space, direction, one, upper);
        continue;
      }
      const segment& image = space.segment_at(direction, end.place);
      const int last = one.first + (upper ? (one.cells - 1) * apart : 0);
      image_[index(direction, upper)][at(last)] = image.first + (upper ? 0 : (image.cells - 1) * apart);
    }
  }
}

void cell_links::add_end(const domain& space, int direction, const segment& one, bool upper) {
  const segment_end& end = one.ends[upper ? 1 : 0];
  gas_end_of_segment found{
      {direction, upper}, space.side(end.surface), space.meeting_point(end.surface, end.place), {}};
  const int apart = space.mesh().stride(direction), last = one.first + (upper ? (one.cells - 1) * apart : 0);
  for (int k = 0; k < 3; ++k)
    found.cells[at(k)] = last + (upper ? -1 : 1) * std::min(k, one.cells - 1) * apart;
  found.copies = found.side->cell_of_ghost(0, one.cells) == 0;
  end_at_[index(direction, upper)][at(last)] = static_cast<int>(ends_.size());
  ends_.push_back(found);
}

}  // namespace apsis
