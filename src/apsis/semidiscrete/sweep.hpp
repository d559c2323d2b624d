#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/exec/aligned.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/semidiscrete/limited_reconstruction.hpp>

#include <vector>

namespace apsis {

/// Edge values of consecutive cells of a pencil, few enough to stay in cache. Blocks reuse the buffers, which
/// are allocated only once.
struct pencil_block {
  /// Allocates buffers for load() with the given number of cells.
  void reserve(const limited_reconstruction& edges, int cells, int halo, int stride);

  /// Computes the edge values of cells begin−halo … end−1+halo of a segment.
  void load(const field& u, const domain& space, const limited_reconstruction& edges, int direction,
            int segment, int begin, int end, int halo);

  /// Returns the row of a cell or ghost cell of the segment.
  const double* row(int cell) const { return rows[static_cast<std::size_t>(cell - first_row)]; }
  /// Returns the row of values at the lower edge of a cell begin−halo … end−1+halo.
  double* left_edge(int cell) { return left.data() + offset(cell); }
  /// Returns the row of values at the upper edge of a cell begin−halo … end−1+halo.
  double* right_edge(int cell) { return right.data() + offset(cell); }

  std::vector<const double*> rows;  ///< rows of the cells from first_row on, owned by the field
  aligned_vector<double> left,      ///< values at lower edges, [cell − first_edge][width]
      right;                        ///< values at upper edges, [cell − first_edge][width]
  int first_row = 0,                ///< cell of rows[0]
      first_edge = 0,               ///< first cell with edge values
      width = 0;                    ///< numbers of a row: the stride of the field

 private:
  std::size_t offset(int cell) const {
    return static_cast<std::size_t>(cell - first_edge) * static_cast<std::size_t>(width);
  }
};

/// Returns the number of cells per block for rows of `width` numbers that are read and written once.
int block_length(int width);

/// Returns the number of cells per block of a pencil_block for rows of `width` numbers. They are enough to
/// amortize the start of a sweep, but fit into the second-level cache.
int collision_block_length(int width);

/// Returns the number of cells per block of a sweep over `columns` numbers of every cell, for
/// the first-level cache.
int sweep_block_length(int columns);

}  // namespace apsis
