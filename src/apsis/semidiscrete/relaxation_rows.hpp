#pragma once

#include <apsis/semidiscrete/upwind_rows.hpp>

#include <span>

namespace apsis {

/// The work of a relaxation on one row, for the instruction set of this processor.
namespace relaxation {

/// u ← stay u + relax e, the convex combination of a stage solve.
void combine(double stay, double relax, const double* e, int width, double* u);

/// stay u + relax e at one of three quadrature points, the weight of the point in both factors.
struct weighted_rows {
  double stay,      ///< factor of u
      relax;        ///< factor of e
  const double *u,  ///< values at the point, one row
      *e;           ///< E(ω) there
};

/// average ← the sum over the points.
void average(const weighted_rows points[3], int width, double* average);

/// What a point contributes to Q/ε: strength (e − u).
struct strong_rows {
  double strength;  ///< C/ε times the weight of the point
  const double *u,  ///< values at the point, one row
      *e;           ///< E(ω) there
};

/// Q/ε = Σ_p strength_p (e_p − u_p), and acc ← (fresh ? 0 : acc) + α u + β Q/ε for every target, with the row
/// u of the cell.
void add_collision(std::span<const strong_rows> points, const double* u, int width,
                   std::span<const upwind::row_target> targets);

/// Averages of cells i−1, i, i+1 and the edge values of cell i.
struct quartic_rows {
  const double *before,  ///< average of cell i−1
      *average,          ///< average of cell i
      *after,            ///< average of cell i+1
      *left,             ///< value at the edge between i−1 and i
      *right;            ///< value at the edge between i and i+1
};

/// points[q·width + k] ← values of the quartics (scheme/quartic.hpp) at the Gauss–Legendre points; `limited`:
/// moved towards the average until these and those at the Gauss–Lobatto points are not negative.
void gauss_values(const quartic_rows& cell, bool limited, int width, double* points);

inline constexpr double operations_of_combine = 2.0,  ///< operations of combine() for one number of a row
    operations_of_average = 6.0;                      ///< operations of average() for one number of a row
/// Operations of gauss_values() for one number of a row, all three points; a multiply–add is one
/// (exec/counted.hpp).
double operations_of_points(bool limited);

}  // namespace relaxation
}  // namespace apsis
