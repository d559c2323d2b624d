#pragma once

#include <apsis/scheme/reconstruction.hpp>

#include <memory>

namespace apsis {

/// Loops of a reconstruction over a pencil.
struct pencil_loops {
  /// Computes both edges; see reconstruction::edges().
  using edge_loop = void (*)(const double* const* rows, int count, int width, double* left, double* right);
  /// Computes outflow edges; see reconstruction::outflow_edges().
  using outflow_loop = void (*)(const double* const* rows, int count, int width, const double* forward,
                                double* edge);
  /// Counts operations; see reconstruction::operations().
  using operation_count = double (*)(bool both_edges);

  edge_loop edges;             ///< loop for both edges
  outflow_loop outflow_edges;  ///< loop for outflow edges alone
  operation_count operations;  ///< operations per number
};

/// Returns a scheme of fifth order, which needs two neighbours on either side.
std::unique_ptr<reconstruction> make_fifth_order(const pencil_loops& loops);

}  // namespace apsis
