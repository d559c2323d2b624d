#pragma once

#include <apsis/core/index.hpp>
#include <apsis/mesh/grid.hpp>

#include <array>
#include <vector>

namespace apsis {

/// A mesh cut into one block of cells for each process: a Cartesian product of cuts along the directions. The
/// blocks of a direction differ by at most one cell.
class block_partition {
 public:
  /// The numbers of blocks along each direction, with product `processes`, for which a block has the smallest
  /// surface towards others. Throws input_error if there is no such product with at least one cell in every
  /// block.
  block_partition(const grid& mesh, int processes);
  /// The given numbers of blocks. Throws input_error unless 1 ≤ blocks ≤ cells in each direction.
  block_partition(const grid& mesh, const std::array<int, 3>& blocks);

  int processes() const { return blocks_[0] * blocks_[1] * blocks_[2]; }  ///< number of blocks
  int blocks(int direction) const { return blocks_[at(direction)]; }      ///< their number along a direction
  /// Returns the cells of a process; the last direction varies fastest with its rank.
  cell_box box(int rank) const;
  /// Returns the number of the block along a direction that contains a cell, counted along it.
  int block_of(int direction, int cell) const;
  /// Returns the place of a process among the blocks of each direction.
  std::array<int, 3> place(int rank) const;
  /// Returns the process at a place.
  int rank(const std::array<int, 3>& place) const;

  /// Returns the number of cells of other processes in the halo of the block with most of them, `width` cells
  /// wide.
  double halo_cells(int width) const;

 private:
  int first_of(int direction, int block) const {
    return static_cast<int>(static_cast<long>(cells_[at(direction)]) * block / blocks_[at(direction)]);
  }

  std::array<int, 3> cells_, blocks_ = {1, 1, 1};
};

}  // namespace apsis
