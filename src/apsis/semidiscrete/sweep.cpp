#include <apsis/semidiscrete/sweep.hpp>

#include <apsis/core/parallel.hpp>

#include <algorithm>

namespace apsis {

void pencil_block::load(const field& u, const grid& mesh, const stencil& how, int direction, int pencil,
                        int begin, int end, int halo) {
  const int ghosts = how.scheme->ghost_width();
  const int count = end - begin + 2 * halo;
  width = u.stride();
  first_edge = begin - halo;
  first_row = first_edge - ghosts;
  pencil_rows(u, mesh, direction, pencil, how.boundary, first_row, end + halo + ghosts, rows);
  const auto needed = static_cast<std::size_t>(count) * static_cast<std::size_t>(width);
  if (left.size() < needed) {
    left.resize(needed);
    right.resize(needed);
  }
  how.scheme->edges(rows.data() + ghosts, count, width, left.data(), right.data());
}

int block_length(int width) {
  constexpr int doubles = 2048;
  return std::clamp(doubles / std::max(width, 1), 8, 256);
}

cell_blocks::cell_blocks(int cells, int longest, int parts) : cells_(cells), parts_(std::max(1, parts)) {
  const int length = cells_ / parts_;
  whole_ = std::max(1, (length + longest / 2) / longest);
  if (parts_ == 1) return;
  // Beginnings of walks cost some cells.
  const int last = length / whole_;
  pieces_ = last >= 64 ? 4 : last >= 32 ? 2 : 1;
}

int cell_blocks::begin(int block) const {
  // In eighths of a whole block: a half, a quarter and two eighths are the last one.
  static constexpr int eighths[] = {0, 4, 6, 7};
  const int part = block / per_part(), i = block % per_part();
  const int whole = std::min(i, whole_ - 1), at = 8 * whole + eighths[i - whole];
  const auto first = [this](int p) { return static_cast<int>(static_cast<long>(cells_) * p / parts_); };
  if (part == parts_) return cells_;
  return first(part) + static_cast<int>(static_cast<long>(first(part + 1) - first(part)) * at / (8 * whole_));
}

int collision_block_length(int width) {
  constexpr int doubles = 4096;  // two edges of each: 64 KiB
  return std::clamp(doubles / std::max(width, 1), 8, 256);
}

int sweep_block_length(int columns) {
  constexpr int doubles = 2048;  // edges of the columns in half of a first-level cache of 32 KiB
  return std::max(doubles / std::max(columns, 1), 16);
}

}  // namespace apsis
