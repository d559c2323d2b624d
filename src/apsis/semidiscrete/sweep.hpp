#pragma once

#include <apsis/core/aligned.hpp>
#include <apsis/space/boundary.hpp>
#include <apsis/space/field.hpp>
#include <apsis/space/grid.hpp>
#include <apsis/space/reconstruction.hpp>

#include <memory>
#include <vector>

namespace apsis {

/// How positivity is kept: by cutting the edge values of cell averages (Zhang & Shu), or by cutting the
/// fluxes of point values.
enum class limiter_kind { none, edges, fluxes };

/// What is to be done with cells begin … end−1 (a call of a lambda, without an allocation); nothing by
/// default.
struct cells_job {
  void (*call)(const void* body, int begin, int end) = nullptr;
  const void* body = nullptr;

  template <class Body>
  static cells_job of(const Body& body) {
    return {[](const void* b, int begin, int end) { (*static_cast<const Body*>(b))(begin, end); }, &body};
  }
  explicit operator bool() const { return call != nullptr; }
  void operator()(int begin, int end) const { call(body, begin, end); }
};

/// How transport and collision see neighbouring cells.
struct stencil {
  std::shared_ptr<const reconstruction> scheme;
  limiter_kind positivity = limiter_kind::none;
  boundary_kind boundary = boundary_kind::periodic;
};

/// A few consecutive cells of one pencil with their edge values, small enough to stay in the cache. Reused
/// from block to block: no allocation once it has grown.
struct pencil_block {
  /// Cells begin−halo … end−1+halo of a pencil get edge values. Rows reach the ghost cells of the scheme.
  void load(const field& u, const grid& mesh, const stencil& how, int direction, int pencil, int begin,
            int end, int halo);

  const double* row(int cell) const { return rows[static_cast<std::size_t>(cell - first_row)]; }
  double* left_edge(int cell) { return left.data() + offset(cell); }
  double* right_edge(int cell) { return right.data() + offset(cell); }

  std::vector<const double*> rows;
  aligned_vector<double> left, right;
  int first_row = 0, first_edge = 0, width = 0;

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
