#pragma once

#include <apsis/exec/communicator.hpp>
#include <apsis/mesh/block_partition.hpp>
#include <apsis/mesh/grid.hpp>

#include <memory>

namespace apsis {

/// A mesh that several processes share: each holds a block of its cells.
struct distribution {
  std::shared_ptr<communicator> processes;  ///< who shares the mesh
  block_partition blocks;                   ///< the block of each process
  grid whole;                               ///< the mesh

  /// Returns the block of this process.
  grid block() const {
    const cell_box box = blocks.box(processes->rank());
    return whole.block(box.first, box.cells);
  }
  /// Returns the process that holds a cell of the mesh.
  int holder(int cell) const;
  /// Returns the number in its block of a cell of the mesh that this process holds; −1 for others.
  int number_in_block(int cell) const;
};

}  // namespace apsis
