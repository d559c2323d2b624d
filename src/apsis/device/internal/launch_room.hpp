#pragma once

#include <apsis/exec/memory_space.hpp>
#include <apsis/mesh/grid.hpp>

#include <algorithm>
#include <cstddef>
#include <span>

namespace apsis {

/// Scratch memory of kernels, the same amount for each cell of a launch. It limits the cells of a launch such
/// that it takes about 128 MiB, but at least one block of cells.
class launch_room {
 public:
  /// `cells`: ranges of cells of all launches. `of_cell`: how many numbers a cell needs, possibly 0.
  launch_room(const memory_space& memory, std::span<const cell_range> cells, std::size_t of_cell) {
    constexpr std::size_t most = 1 << 24;
    for (const cell_range& some : cells) cells_ = std::max(cells_, some.end - some.begin);
    if (of_cell == 0) return;
    const int blocks = static_cast<int>(std::min<std::size_t>(most / of_cell, 1 << 24)) / cells_of_block;
    cells_ = std::min(cells_, std::max(blocks, 1) * cells_of_block);
    // The last block may have fewer cells.
    numbers_ = stored_numbers(static_cast<std::size_t>(cells_ + cells_of_block) * of_cell, memory);
  }

  /// Largest number of cells of a block.
  static constexpr int cells_of_block = 16;

  double* data() { return numbers_.data(); }  ///< the memory
  /// Calls launch(first, last) for parts of a range of cells for which the memory suffices.
  template <class Launch>
  void for_parts(const cell_range& of, const Launch& launch) const {
    for (int first = of.begin; first < of.end; first += cells_)
      launch(first, std::min(first + cells_, of.end));
  }

 private:
  int cells_ = 0;
  stored_numbers numbers_;
};

}  // namespace apsis
