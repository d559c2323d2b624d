#pragma once

#include <cstddef>
#include <span>

namespace apsis {

/// Loops over the components of rows of a relaxation, for the instruction set of this processor.
namespace relaxation {

/// u ← weight_of_u·u + weight_of_e·e, the convex combination that solves a stage. The sum of the weights is 1
/// up to rounding. Only the smaller weight enters: the result is the row of the larger weight plus this
/// fraction of the difference. It is therefore nonnegative if both rows are. If both rows have equal moments,
/// so has the result, however the weights are rounded.
void combine(double weight_of_u, double weight_of_e, const double* e, int width, double* u);

/// The contribution of the combination at one quadrature point to a mean.
struct weighted_rows {
  double weight,       ///< quadrature weight of the point
      share;           ///< weight · (smaller weight of the combination)
  const double *base,  ///< row of the larger weight
      *other;          ///< row of the smaller weight
};

/// Returns the contribution of a point with the quadrature weight `weight` and the weights of combine().
inline weighted_rows contribution(double weight, double weight_of_u, double weight_of_e, const double* u,
                                  const double* e) {
  if (weight_of_e <= weight_of_u) return {weight, weight * weight_of_e, u, e};
  return {weight, weight * weight_of_u, e, u};
}

/// mean ← the sum of the contributions. Three points have a faster kernel.
void mean(std::span<const weighted_rows> points, int width, double* mean);

/// q ← strength (e − u), with strength = C/ε.
void change(double strength, const double* e, const double* u, int width, double* q);

inline constexpr double operations_of_combine = 2.0;  ///< operations of combine() per component
/// Returns the operations of mean() per component.
constexpr double operations_of_mean(std::size_t points) {
  return 3.0 * static_cast<double>(points);
}

}  // namespace relaxation
}  // namespace apsis
