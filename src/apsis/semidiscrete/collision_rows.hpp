#pragma once

#include <apsis/semidiscrete/upwind_rows.hpp>

#include <span>

namespace apsis {

/// Loops of the collision operators over the components of rows, for the instruction set of this processor.
namespace collision_rows {

/// Contribution of a quadrature point to Q(u)/ε of a cell.
struct weighted_row {
  double weight;    ///< quadrature weight of the point
  const double* q;  ///< Q/ε at the point, one row
};

/// For every target: acc ← (fresh ? 0 : acc) + α u + β Σ_p weight_p q_p, with the row u of the cell.
void add(std::span<const weighted_row> points, const double* u, int width,
         std::span<const upwind::row_target> targets);

/// Averages of cells i−1, i, i+1 and edge values of cell i, one row each.
struct quartic_rows {
  const double *before,  ///< average of cell i−1
      *average,          ///< average of cell i
      *after,            ///< average of cell i+1
      *left,             ///< value at the edge between i−1 and i
      *right;            ///< value at the edge between i and i+1
};

/// points[q·width + k] ← values of the quartics (scheme/quartic.hpp) at the Gauss–Legendre points. If
/// `limited`, the quartics are moved towards the average until their values there and at the Gauss–Lobatto
/// points are nonnegative.
void gauss_values(const quartic_rows& cell, bool limited, int width, double* points);

/// Returns the operations of gauss_values() for one number of a row at all three points (exec/counted.hpp). A
/// multiply–add counts as one.
double operations_of_points(bool limited);

}  // namespace collision_rows
}  // namespace apsis
