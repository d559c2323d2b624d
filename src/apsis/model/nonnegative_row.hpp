#pragma once

#include <apsis/velocity/velocity_grid.hpp>

namespace apsis {

/// m ← a row m ≥ 0 with the moments ω = (ρ, ρu, 𝓔), ρ > 0, that is positive at five velocities or fewer.
/// Solves Σ w m (1, v, ½|v|²) = ω by nonnegative least squares (Lawson & Hanson, Solving Least Squares
/// Problems, 1974, ch. 23). If ω is next to the boundary of the realizable moments, all rows with these
/// moments are close to m. Returns false if the relative error of the moments exceeds 1e-12, where momenta
/// are relative to ρ √(2𝓔/ρ).
bool nonnegative_row(const velocity_grid& grid, const double* omega, double* m);

}  // namespace apsis
