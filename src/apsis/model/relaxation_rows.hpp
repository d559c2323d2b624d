#pragma once

#include <cstddef>
#include <span>

namespace apsis {

/// Loops over the components of rows of a relaxation, for the instruction set of this processor.
namespace relaxation {

/// u ← weight_of_u·u + weight_of_e·e, the convex combination that solves a stage.
void combine(double weight_of_u, double weight_of_e, const double* e, int width, double* u);

/// weight_of_u·u + weight_of_e·e at one quadrature point, the weight of the point in both factors.
struct weighted_rows {
  double weight_of_u,  ///< factor of u
      weight_of_e;     ///< factor of e
  const double *u,     ///< values at the point, one row
      *e;              ///< E(ω) there
};

/// mean ← the sum over the points; three points are the fast case.
void mean(std::span<const weighted_rows> points, int width, double* mean);

/// q ← strength (e − u), with strength = C/ε.
void change(double strength, const double* e, const double* u, int width, double* q);

inline constexpr double operations_of_combine = 2.0;  ///< operations of combine() per component
/// Operations of mean() per component.
constexpr double operations_of_mean(std::size_t points) {
  return 2.0 * static_cast<double>(points);
}

}  // namespace relaxation
}  // namespace apsis
