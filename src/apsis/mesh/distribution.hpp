#pragma once

#include <apsis/exec/communicator.hpp>
#include <apsis/mesh/block_partition.hpp>
#include <apsis/mesh/grid.hpp>

#include <memory>

namespace apsis {

/// A mesh that several processes share. Each process holds one block of cells.
struct distribution {
  std::shared_ptr<communicator> processes;  ///< processes that share the mesh
  block_partition blocks;                   ///< the block of each process
  grid whole;                               ///< the mesh

  /// Returns the block of this process.
  grid block() const {
    const cell_box box = blocks.box(processes->rank());
    return whole.block(box.first, box.cells);
  }
  /// Returns the rank of the process that holds a cell of the mesh.
  int holder(int cell) const;
  /// Returns the number of a cell of the mesh in the block of this process; −1 if another process holds it.
  int number_in_block(int cell) const;
};

}  // namespace apsis
