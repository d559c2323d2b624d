#include <apsis/semidiscrete/sweep.hpp>

#include <algorithm>

namespace apsis {

void pencil_block::reserve(const limited_reconstruction& edges, int cells, int halo, int stride) {
  const auto count = static_cast<std::size_t>(cells) + 2 * static_cast<std::size_t>(halo);
  rows.reserve(count + 2 * static_cast<std::size_t>(edges.scheme->ghost_width()));
  const std::size_t needed = count * static_cast<std::size_t>(stride);
  if (left.size() >= needed) return;
  left.resize(needed);
  right.resize(needed);
}

void pencil_block::load(const field& u, const domain& space, const limited_reconstruction& edges,
                        int direction, int segment, int begin, int end, int halo) {
  const int ghosts = edges.scheme->ghost_width();
  const int count = end - begin + 2 * halo;
  width = u.stride();
  first_edge = begin - halo;
  first_row = first_edge - ghosts;
  space.segment_rows(u, direction, segment, first_row, end + halo + ghosts, rows);
  reserve(edges, end - begin, halo, width);
  edges.scheme->edges(rows.data() + ghosts, count, width, left.data(), right.data());
}

int block_length(int width) {
  constexpr int doubles = 2048;
  return std::clamp(doubles / std::max(width, 1), 8, 256);
}

int collision_block_length(int width) {
  constexpr int doubles = 4096;  // two edges for each: 64 KiB
  return std::clamp(doubles / std::max(width, 1), 8, 256);
}

int sweep_block_length(int columns) {
  constexpr int doubles = 2048;  // edges of the columns in half of a first-level cache of 32 KiB
  return std::max(doubles / std::max(columns, 1), 16);
}

}  // namespace apsis
