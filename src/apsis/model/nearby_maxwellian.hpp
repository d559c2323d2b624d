#pragma once

#include <apsis/model/line_moments.hpp>
#include <apsis/model/maxwellian.hpp>

#include <span>

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

/// A row that becomes the discrete Maxwellian of an admissible state.
struct row_of_state {
  const double* omega;  ///< moments
  fluid_state state;    ///< their state
  double* m;            ///< the row; on a line it must contain the Gaussian of the state
};
/// Computes several rows, each with the bits of discrete_maxwellian(). Groups of cells share the operations
/// of Newton's method. Returns the number of rows before the first ω that has none.
int discrete_maxwellians(const velocity_grid& grid, std::span<const row_of_state> rows);

}  // namespace apsis
