#pragma once

#include <apsis/velocity/velocity_grid.hpp>

namespace apsis {

/// m ← a row m ≥ 0 with the moments ω = (ρ, ρu, 𝓔), ρ > 0, that is positive at five velocities or fewer:
/// nonnegative least squares for Σ w m (1, v, ½|v|²) = ω (Lawson & Hanson, Solving Least Squares Problems,
/// 1974, ch. 23). Where ω is next to the boundary of the realizable moments, all rows with these moments are
/// near to m. Returns false if its moments are not ω to 1e-12 of those of all molecules.
bool nonnegative_row(const velocity_grid& grid, const double* omega, double* m);

}  // namespace apsis
