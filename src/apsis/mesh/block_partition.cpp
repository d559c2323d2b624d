#include <apsis/mesh/block_partition.hpp>

#include <algorithm>
#include <optional>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Calls body(blocks) for all three numbers of blocks whose product is `processes`.
template <class Body>
void for_products(int processes, const Body& body) {
  for (int i = 1; i <= processes; ++i) {
    if (processes % i != 0) continue;
    for (int j = 1; j <= processes / i; ++j)
      if (processes / i % j == 0) body(std::array<int, 3>{i, j, processes / i / j});
  }
}

std::optional<block_partition> best_partition(const grid& mesh, int processes) {
  std::optional<block_partition> best;
  for_products(processes, [&](const std::array<int, 3>& blocks) {
    for (int k = 0; k < 3; ++k)
      if (blocks[static_cast<std::size_t>(k)] > mesh.cells(k)) return;
    const block_partition one(mesh, blocks);
    // Among equally good partitions, take the one with most blocks along x: their rows are contiguous in
    // memory and in files.
    if (!best || one.halo_cells(1) <= best->halo_cells(1)) best = one;
  });
  return best;
}

block_partition best_or_throw(const grid& mesh, int processes) {
  if (auto best = best_partition(mesh, processes)) return *best;
  int fewer = std::min(processes, mesh.size());
  while (fewer > 1 && !best_partition(mesh, fewer)) --fewer;
  throw input_error(
      fmt::format("{} processes cannot share the mesh (no product of numbers of blocks gives each a cell in "
                  "every direction); start {}",
                  processes, fewer));
}

}  // namespace

block_partition::block_partition(const grid& mesh, int processes)
    : block_partition(best_or_throw(mesh, processes)) {}

block_partition::block_partition(const grid& mesh, const std::array<int, 3>& blocks)
    : cells_{mesh.cells(0), mesh.cells(1), mesh.cells(2)}, blocks_(blocks) {
  for (int k = 0; k < 3; ++k)
    if (blocks[at(k)] < 1 || blocks[at(k)] > mesh.cells(k))
      throw input_error(fmt::format("{} blocks along direction {} (it has {} cells); give 1 to {}",
                                    blocks[at(k)], k + 1, mesh.cells(k), mesh.cells(k)));
}

std::array<int, 3> block_partition::place(int rank) const {
  return {rank / blocks_[2] / blocks_[1], rank / blocks_[2] % blocks_[1], rank % blocks_[2]};
}

int block_partition::rank(const std::array<int, 3>& place) const {
  return (place[0] * blocks_[1] + place[1]) * blocks_[2] + place[2];
}

cell_box block_partition::box(int rank) const {
  cell_box box;
  const auto at_place = place(rank);
  for (int k = 0; k < 3; ++k) {
    box.first[at(k)] = first_of(k, at_place[at(k)]);
    box.cells[at(k)] = first_of(k, at_place[at(k)] + 1) - box.first[at(k)];
  }
  return box;
}

int block_partition::block_of(int direction, int cell) const {
  int block = static_cast<int>(static_cast<long>(cell) * blocks_[at(direction)] / cells_[at(direction)]);
  while (first_of(direction, block + 1) <= cell) ++block;
  return block;
}

double block_partition::halo_cells(int width) const {
  // Sides of the largest block.
  std::array<double, 3> side{};
  for (std::size_t k = 0; k < 3; ++k) {
    const int longest = (cells_[k] + blocks_[k] - 1) / blocks_[k];
    side[k] = longest;
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    sum += std::min(2, blocks_[k] - 1) * width * side[0] * side[1] * side[2] / side[k];
  return sum;
}

}  // namespace apsis
