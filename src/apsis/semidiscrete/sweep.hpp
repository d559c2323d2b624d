#pragma once

#include <apsis/exec/aligned.hpp>
#include <apsis/phase/domain.hpp>
#include <apsis/phase/field.hpp>
#include <apsis/scheme/reconstruction.hpp>

#include <memory>
#include <vector>

namespace apsis {

/// How positivity is kept.
enum class limiter_kind {
  none,   ///< no limiter
  edges,  ///< edge values of cell averages are moved towards the average (Zhang & Shu)
  fluxes  ///< fluxes of point values are moved towards first-order upwind (Zalesak, Xu)
};

/// What is to be done with cells begin … end−1 (a call of a lambda, without an allocation); nothing by
/// default.
struct cells_job {
  void (*call)(const void* body, int begin, int end) = nullptr;  ///< calls the lambda; null: nothing to do
  const void* body = nullptr;                                    ///< the lambda, which is not copied

  /// body(begin, end); `body` must outlive the job.
  template <class Body>
  static cells_job of(const Body& body) {
    return {[](const void* b, int begin, int end) { (*static_cast<const Body*>(b))(begin, end); }, &body};
  }
  /// Whether there is anything to do.
  explicit operator bool() const { return call != nullptr; }
  /// Calls the lambda, which must be there.
  void operator()(int begin, int end) const { call(body, begin, end); }
};

/// How transport and collision see neighbouring cells.
struct stencil {
  std::shared_ptr<const reconstruction> scheme;  ///< of edge values; null without space
  limiter_kind positivity = limiter_kind::none;  ///< limiter of edges or fluxes
};

/// A few consecutive cells of one pencil with their edge values, small enough to stay in the cache. Reused
/// from block to block: no allocation once it has grown.
struct pencil_block {
  /// Makes room for load() with so many cells.
  void reserve(const stencil& how, int cells, int halo, int stride);

  /// Cells begin−halo … end−1+halo of a pencil get edge values. Rows reach the ghost cells of the scheme.
  void load(const field& u, const domain& space, const stencil& how, int direction, int pencil, int begin,
            int end, int halo);

  /// The components of a cell of the pencil, or of a ghost cell.
  const double* row(int cell) const { return rows[static_cast<std::size_t>(cell - first_row)]; }
  /// One row: the values of a cell of begin−halo … end−1+halo at its lower edge.
  double* left_edge(int cell) { return left.data() + offset(cell); }
  /// One row: the values of such a cell at its upper edge.
  double* right_edge(int cell) { return right.data() + offset(cell); }

  std::vector<const double*> rows;  ///< of the cells from first_row on; they belong to the field
  aligned_vector<double> left,      ///< values at lower edges, [cell − first_edge][width]
      right;                        ///< values at upper edges, [cell − first_edge][width]
  int first_row = 0,                ///< cell of rows[0]
      first_edge = 0,               ///< first cell with edge values
      width = 0;                    ///< of a row: the stride of the field

 private:
  std::size_t offset(int cell) const {
    return static_cast<std::size_t>(cell - first_edge) * static_cast<std::size_t>(width);
  }
};

/// Cells per block for rows of `width` numbers that are read and written once.
int block_length(int width);

/// Cells of a block whose edge values a pencil_block holds for rows of `width` numbers: many enough that the
/// beginning of a walk costs little, few enough for the second-level cache.
int collision_block_length(int width);

/// Likewise of a block of a sweep over `columns` numbers of every cell: for the first-level cache.
int sweep_block_length(int columns);

}  // namespace apsis
