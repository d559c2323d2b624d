#include <apsis/mesh/segments.hpp>

#include <apsis/core/index.hpp>

namespace apsis {
segment_table::segment_table(const grid& mesh, const std::array<bool, 3>& periodic)
    : segment_table(mesh, mesh, periodic, 0) {}

segment_table::segment_table(const grid& whole, const grid& block, const std::array<bool, 3>& periodic,
                             int reach) {
  const int dimensions = block.dimensions(), solids = block.obstacles() + (block.cut() != nullptr ? 1 : 0);
  for (int solid = -1; solid < solids; ++solid)
    for (std::size_t k = 0; k < 2 * at(dimensions); ++k) {
      face where = face_of(k);
      if (solid >= 0) where.upper = !where.upper;  // upper ends of segments lie at lower faces
      surfaces_.push_back({where, solid, {}, 0});
    }
  for (int direction = 0; direction < dimensions; ++direction) {
    cut(block, direction);
    if (block.cells(direction) == whole.cells(direction))
      link(direction, periodic[at(direction)], block);
    else
      continue_beyond(whole, block, direction, periodic[at(direction)], reach);
  }
}

void segment_table::cut(const grid& mesh, int direction) {
  const int n = mesh.cells(direction), stride = mesh.stride(direction);
  auto& made = along_[at(direction)];
  auto& first_of = first_of_[at(direction)];
  for (int pencil = 0; pencil < mesh.pencils(direction); ++pencil) {
    first_of.push_back(static_cast<int>(made.size()));
    const int first = mesh.first_cell(direction, pencil);
    bool inside = false;
    for (int i = 0; i < n; ++i) {
      const bool fluid = mesh.obstacle(first + i * stride) < 0;
      if (fluid && !inside) made.push_back({first + i * stride, i, 0, {}});
      if (fluid) ++made.back().cells;
      inside = fluid;
    }
  }
  first_of.push_back(static_cast<int>(made.size()));
}

/// Sets both ends of every segment of a direction that is not divided among processes.
void segment_table::link(int direction, bool periodic, const grid& mesh) {
  const int n = mesh.cells(direction), stride = mesh.stride(direction), faces = 2 * mesh.dimensions();
  auto& segments = along_[at(direction)];
  for (int pencil = 0; pencil < mesh.pencils(direction); ++pencil) {
    const int begin = first_of(direction, pencil), end = first_of(direction, pencil + 1);
    const int pencil_first = mesh.first_cell(direction, pencil);
    for (int number = begin; number < end; ++number)
      for (const bool upper : {false, true}) {
        segment& one = segments[at(number)];
        int beside = upper ? one.offset + one.cells : one.offset - 1;
        const int at_face = static_cast<int>(face{direction, upper}.index());
        if (beside < 0 || beside >= n) {
          if (!periodic) {
            end_at(at_face, direction, number, upper);
            continue;
          }
          beside = upper ? 0 : n - 1;
          const int opposite = upper ? begin : end - 1;
          if (mesh.obstacle(pencil_first + beside * stride) < 0) {
            one.ends[upper ? 1 : 0] = {-1, opposite};
            continue;
          }
        }
        const int solid = mesh.obstacle(pencil_first + beside * stride);
        // Upper ends of segments lie at lower faces of obstacles, lower ends at upper faces.
        end_at(faces * (solid + 1) + 2 * direction + (upper ? 0 : 1), direction, number, upper);
      }
  }
}

/// Sets both ends of every segment of a direction in which other processes continue the pencils. At each
/// surface, ends at cells of this process come first.
void segment_table::continue_beyond(const grid& whole, const grid& block, int direction, bool periodic,
                                    int reach) {
  struct other_end {
    int surface, number;
    bool upper;
  };
  std::vector<other_end> others;
  for (int number = 0; number < static_cast<int>(along(direction).size()); ++number)
    for (const bool upper : {false, true}) {
      const int surface = surface_beyond(whole, block, direction, periodic, reach, number, upper);
      segment& one = along_[at(direction)][at(number)];
      if (surface < 0)
        one.ends[upper ? 1 : 0] = {-1, -1};
      else if (one.ends_here(upper))
        end_at(surface, direction, number, upper);
      else
        others.push_back({surface, number, upper});
    }
  for (const auto& [surface, number, upper] : others) end_at(surface, direction, number, upper);
}

/// Counts the cells of other processes beyond an end, and returns the surface behind them. Returns −1 if the
/// surface is farther away than `reach` cells.
int segment_table::surface_beyond(const grid& whole, const grid& block, int direction, bool periodic,
                                  int reach, int number, bool upper) {
  segment& one = along_[at(direction)][at(number)];
  int& beyond = one.beyond[upper ? 1 : 0];
  const int outwards = upper ? 1 : -1, last = upper ? one.offset + one.cells - 1 : one.offset;
  const int cell = whole.cell_of(block, one.first + (last - one.offset) * block.stride(direction));
  const int here = block.first(direction) + last, all = whole.cells(direction);
  for (;; ++beyond) {
    int beside = here + (beyond + 1) * outwards;
    if (!periodic && (beside < 0 || beside >= all)) return static_cast<int>(face{direction, upper}.index());
    beside = (beside % all + all) % all;
    const int solid = whole.obstacle(cell + (beside - here) * whole.stride(direction));
    // Upper ends of segments lie at lower faces of obstacles, lower ends at upper faces.
    if (solid >= 0) return 2 * block.dimensions() * (solid + 1) + 2 * direction + (upper ? 0 : 1);
    if (beyond == reach) return -1;
  }
}

void segment_table::end_at(int surface, int direction, int number, bool upper) {
  auto& ends = surfaces_[at(surface)].segments;
  segment& one = along_[at(direction)][at(number)];
  one.ends[upper ? 1 : 0] = {surface, static_cast<int>(ends.size())};
  ends.push_back(number);
  if (one.ends_here(upper)) ++surfaces_[at(surface)].own;
}

}  // namespace apsis
