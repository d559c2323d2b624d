#include <apsis/steady/cell_links.hpp>

#include <apsis/mesh/cut_cells.hpp>

#include <algorithm>

namespace apsis {

cell_links::cell_links(const domain& space) : directions_(space.mesh().dimensions()) {
  add_cells(space);
  for (auto* links : {&next_, &image_, &end_at_})
    for (auto& of_face : *links) of_face.assign(at(space.mesh().size()), -1);
  for (int direction = 0; direction < directions_; ++direction) link(space, direction);
}

void cell_links::add_cells(const domain& space) {
  const grid& mesh = space.mesh();
  const cut_cells* cut = mesh.cut();
  if (cut != nullptr) {
    cut_at_.assign(6, std::vector<int>(at(mesh.size()), -1));
    volumes_.assign(at(mesh.size()), 1.0);
  }
  for (int cell = 0; cell < mesh.size(); ++cell) {
    if (mesh.solid(cell) >= 0) continue;
    if (const int group = mesh.cut_group(cell); cut != nullptr && group >= 0) {
      const cut_group& of = cut->groups()[at(group)];
      if (space.number_in_block(of.cells.front()) != cell) continue;
      volumes_[at(cell)] = of.volume / mesh.cell_volume();
    }
    cells_.push_back(cell);
  }
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
      if (end.surface >= 0 && space.is_border_of_cut_cells(end.surface)) {
        note_cut_cell(space, direction, upper, one.first + (upper ? (one.cells - 1) * apart : 0));
        continue;
      }
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

/// Stores the group of the cut cell next to the last cell of a segment.
void cell_links::note_cut_cell(const domain& space, int direction, bool upper, int last) {
  const grid& mesh = space.mesh();
  const int along = last / mesh.stride(direction) % mesh.cells(direction) + (upper ? 1 : -1);
  if (along < 0 || along >= mesh.cells(direction)) return;  // across a periodic face, or of another process
  const int group = mesh.cut_group(last + (upper ? 1 : -1) * mesh.stride(direction));
  cut_at_[index(direction, upper)][at(last)] =
      space.number_in_block(mesh.cut()->groups()[at(group)].cells.front());
}

void cell_links::add_end(const domain& space, int direction, const segment& one, bool upper) {
  const segment_end& end = one.ends[upper ? 1 : 0];
  gas_end_of_segment found{
      {direction, upper}, space.side(end.surface), space.meeting_point(end.surface, end.place), {}};
  const int apart = space.mesh().stride(direction), last = one.first + (upper ? (one.cells - 1) * apart : 0);
  for (int k = 0; k < 3; ++k)
    found.cells[at(k)] = last + (upper ? -1 : 1) * std::min(k, one.cells - 1) * apart;
  found.copied = found.side->multiple_of_cell(found.where, found.at, one.cells);
  end_at_[index(direction, upper)][at(last)] = static_cast<int>(ends_.size());
  ends_.push_back(found);
}

}  // namespace apsis
