#pragma once

#include <apsis/model/formulas/small_matrix.hpp>
#include <apsis/model/maxwellian.hpp>

namespace apsis {

/// A symmetric matrix over the resolved directions, stored in the first rows and columns.
using direction_matrix = scalar::small_matrix<3>;

/// m ← ρ (det 2πΘ)^{−1/2} exp(−½ cᵀΘ⁻¹c), c = v − u, at the grid.size() points of the grid. Takes the
/// positive definite covariance Θ and its inverse. Values below 1e-300 may be 0. Dimensionless.
void correlated_gaussian(const velocity_grid& grid, const fluid_state& state,
                         const direction_matrix& covariance, const direction_matrix& inverse, double* m);

}  // namespace apsis
