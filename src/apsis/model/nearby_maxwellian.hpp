#pragma once

#include <apsis/model/line_moments.hpp>
#include <apsis/model/maxwellian.hpp>

namespace apsis {

/// m ← the discrete Maxwellian of an admissible state. Newton's method starts from the Gaussian of the state.
/// The steps multiply weights by exponentials of small numbers, which need no reduction of their argument.
/// Returns false, with m undefined, if a step is not small: on coarse grids, near their ends and in nearly
/// empty space. Sets `moments`, if given, to the central moments of m.
bool nearby_maxwellian(const velocity_grid& grid, const fluid_state& state, double* m,
                       line_moments* moments = nullptr);

/// m ← the discrete Maxwellian for the moments ω of any row f ≥ 0, with the results of discrete_maxwellian().
/// Takes longer than nearby_maxwellian(), and computes the same row to rounding.
bool general_maxwellian(const velocity_grid& grid, const double* omega, double* m);

/// Computes nearby_maxwellian() on a line, starting from m, which must contain the Gaussian of the state.
bool nearby_maxwellian_on_line(const velocity_grid& grid, const line_state& state, double* m,
                               line_moments* moments = nullptr);

}  // namespace apsis
