#include <apsis/semidiscrete/gathered_cells.hpp>

#include <algorithm>
#include <cstddef>
#include <span>

namespace apsis {

std::vector<double> gather_cells(const problem_builder& builder, std::vector<double> mine, int per_cell) {
  if (!builder.blocks()) return mine;
  const auto& [processes, blocks, whole] = *builder.blocks();
  const std::vector<double> all = gather_numbers(*processes, mine);
  if (!processes->is_root()) return {};
  std::vector<double> values(all.size());
  const double* from = all.data();
  for (int rank = 0; rank < processes->size(); ++rank) {
    const cell_box box = blocks.box(rank);
    const grid block = whole.block(box.first, box.cells);
    for (int cell = 0; cell < block.size(); ++cell, from += per_cell)
      std::copy_n(from, per_cell,
                  values.data() + static_cast<std::ptrdiff_t>(whole.cell_of(block, cell)) * per_cell);
  }
  return values;
}

std::vector<double> scatter_cells(const problem_builder& builder, std::vector<double> all, int per_cell) {
  if (!builder.blocks()) return all;
  const auto& [processes, blocks, whole] = *builder.blocks();
  all.resize(static_cast<std::size_t>(whole.size()) * static_cast<std::size_t>(per_cell));
  processes->broadcast(std::as_writable_bytes(std::span(all)));
  const grid& block = builder.mesh();
  std::vector<double> mine(static_cast<std::size_t>(block.size()) * static_cast<std::size_t>(per_cell));
  for (int cell = 0; cell < block.size(); ++cell)
    std::copy_n(all.data() + static_cast<std::ptrdiff_t>(whole.cell_of(block, cell)) * per_cell, per_cell,
                mine.data() + static_cast<std::ptrdiff_t>(cell) * per_cell);
  return mine;
}

}  // namespace apsis
