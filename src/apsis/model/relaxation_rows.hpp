#pragma once

#include <cstddef>
#include <span>

namespace apsis {

/// Loops over the components of rows of a relaxation, for the instruction set of this processor.
namespace relaxation {

/// u ← weight_of_u·u + weight_of_e·e, the convex combination that solves a stage, for weights whose sum is 1
/// up to rounding. It is computed from the smaller weight alone, as the row of the larger weight plus this
/// fraction of the difference: nonnegative if both rows are, and a difference without moments adds none,
/// however the weights are rounded.
void combine(double weight_of_u, double weight_of_e, const double* e, int width, double* u);

/// The combination at one quadrature point as its contribution to a mean.
struct weighted_rows {
  double weight,       ///< quadrature weight of the point
      share;           ///< weight · (smaller weight of the combination)
  const double *base,  ///< row of the larger weight
      *other;          ///< row of the smaller weight
};

/// Returns the contribution of a point, with the weights of combine().
inline weighted_rows contribution(double weight, double weight_of_u, double weight_of_e, const double* u,
                                  const double* e) {
  if (weight_of_e <= weight_of_u) return {weight, weight * weight_of_e, u, e};
  return {weight, weight * weight_of_u, e, u};
}

/// mean ← the sum over the points; three points are the fast case.
void mean(std::span<const weighted_rows> points, int width, double* mean);

/// q ← strength (e − u), with strength = C/ε.
void change(double strength, const double* e, const double* u, int width, double* q);

inline constexpr double operations_of_combine = 2.0;  ///< operations of combine() per component
/// Operations of mean() per component.
constexpr double operations_of_mean(std::size_t points) {
  return 3.0 * static_cast<double>(points);
}

}  // namespace relaxation
}  // namespace apsis
