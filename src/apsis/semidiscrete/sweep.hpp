#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/exec/aligned.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/scheme/reconstruction.hpp>

#include <memory>
#include <vector>

namespace apsis {

/// Positivity limiter.
enum class limiter_kind {
  none,   ///< no limiter
  edges,  ///< scales edge values of cell averages towards the average (Zhang & Shu)
  fluxes  ///< blends fluxes of point values with first-order upwind (Zalesak, Xu)
};

/// A function of cells begin … end−1, a reference to a lambda that does not allocate; empty by default.
struct cells_job {
  void (*call)(const void* body, int begin, int end) = nullptr;  ///< calls the lambda; null if empty
  const void* body = nullptr;                                    ///< the lambda, not copied

  /// Returns a job that calls body(begin, end); `body` must outlive it.
  template <class Body>
  static cells_job of(const Body& body) {
    return {[](const void* b, int begin, int end) { (*static_cast<const Body*>(b))(begin, end); }, &body};
  }
  /// Whether the job is not empty.
  explicit operator bool() const { return call != nullptr; }
  /// Calls the lambda; the job must not be empty.
  void operator()(int begin, int end) const { call(body, begin, end); }
};

/// Spatial discretization: reconstruction and limiter.
struct spatial_discretization {
  std::shared_ptr<const reconstruction> scheme;  ///< reconstruction of edge values; null without space
  limiter_kind positivity = limiter_kind::none;  ///< positivity limiter of edges or fluxes
};

/// Edge values of consecutive cells of a pencil, few enough to stay in cache. The buffers are reused from
/// block to block, so that they are allocated once.
struct pencil_block {
  /// Allocates buffers for load() with the given number of cells.
  void reserve(const spatial_discretization& discretization, int cells, int halo, int stride);

  /// Computes the edge values of cells begin−halo … end−1+halo of a segment.
  void load(const field& u, const domain& space, const spatial_discretization& discretization, int direction,
            int segment, int begin, int end, int halo);

  /// Returns the row of a cell or ghost cell of the segment.
  const double* row(int cell) const { return rows[static_cast<std::size_t>(cell - first_row)]; }
  /// Returns the row of values at the lower edge of a cell begin−halo … end−1+halo.
  double* left_edge(int cell) { return left.data() + offset(cell); }
  /// Returns the row of values at the upper edge of such a cell.
  double* right_edge(int cell) { return right.data() + offset(cell); }

  std::vector<const double*> rows;  ///< rows of the cells from first_row on, owned by the field
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

/// Returns the cells per block for rows of `width` numbers that are read and written once.
int block_length(int width);

/// Returns the cells per block of a pencil_block for rows of `width` numbers: enough to amortize the start of
/// a sweep, few enough for the second-level cache.
int collision_block_length(int width);

/// Returns the cells per block of a sweep over `columns` numbers of every cell, for the first-level cache.
int sweep_block_length(int columns);

}  // namespace apsis
