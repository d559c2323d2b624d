#pragma once

#include <apsis/core/index.hpp>
#include <apsis/mesh/grid.hpp>

#include <array>
#include <vector>

namespace apsis {

/// A mesh divided into one block of cells per process, by a Cartesian product of cuts along the directions.
/// The sizes of blocks along a direction differ by at most one cell.
class block_partition {
 public:
  /// Chooses the numbers of blocks along each direction, with product `processes`, for which the largest
  /// block has the smallest halo. Throws input_error if every such product leaves a block without cells.
  block_partition(const grid& mesh, int processes);
  /// Takes the numbers of blocks along each direction. Throws input_error unless 1 ≤ blocks ≤ cells in
  /// each direction.
  block_partition(const grid& mesh, const std::array<int, 3>& blocks);

  int processes() const { return blocks_[0] * blocks_[1] * blocks_[2]; }  ///< number of blocks
  int blocks(int direction) const { return blocks_[at(direction)]; }      ///< number along a direction
  /// Returns the cells of the process `rank`. The last direction varies fastest with the rank.
  cell_box box(int rank) const;
  /// Returns the number, along a direction, of the block that contains a cell. The cell is counted along
  /// this direction.
  int block_of(int direction, int cell) const;
  /// Returns the number of the block of a process along each direction.
  std::array<int, 3> place(int rank) const;
  /// Returns the rank of the process whose block has these numbers.
  int rank(const std::array<int, 3>& place) const;

  /// Returns the number of cells in the halo of the largest block, for a halo of `width` cells.
  double halo_cells(int width) const;

 private:
  int first_of(int direction, int block) const {
    return static_cast<int>(static_cast<long>(cells_[at(direction)]) * block / blocks_[at(direction)]);
  }

  std::array<int, 3> cells_, blocks_ = {1, 1, 1};
};

}  // namespace apsis
