#pragma once

#include <apsis/exec/aligned.hpp>
#include <apsis/model/fluid_state.hpp>
#include <apsis/model/grid_sums.hpp>
#include <apsis/model/line_moments.hpp>
#include <apsis/model/velocity_rows.hpp>
#include <apsis/velocity/velocity_grid.hpp>

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// omega ← the d + 2 midpoint-rule moments (ρ, ρu, 𝓔) of a row of grid.size() values.
void kinetic_moments(const velocity_grid& grid, const double* f, double* omega);
/// The moments of several rows, `pitch` numbers apart, one ω after the other.
void kinetic_moments(const velocity_grid& grid, const double* f, std::ptrdiff_t pitch, int rows,
                     double* omega);

/// Returns the last direction of a grid with the weights that sum with functions_of_lines().
grid_sums::axis last_axis(const velocity_grid& grid);
/// Returns the first moment, the density ρ of a row.
double kinetic_mass(const velocity_grid& grid, const double* f);

/// Compact fluid_state of one velocity dimension.
struct line_state {
  double rho,  ///< density
      u,       ///< bulk velocity
      T;       ///< temperature
  /// Whether all values are finite, ρ > 0 and T > 0.
  bool admissible() const { return rho > 0.0 && T > 0.0 && std::isfinite(rho + std::abs(u) + T); }
};

/// Rows of Gaussians at the points of a line, `pitch` numbers apart; below 1e-300 values are 0.
void gaussians_on(const velocity_line& line, const velocity_rows::gaussian* of_rows, int rows, double* m,
                  std::ptrdiff_t pitch);

/// M[ρ, u, T](v) = ρ (2πT)^{−d/2} exp(−|v − u|²/(2T)) at the grid points (paper, after eq. BGK).
void formula_maxwellian(const velocity_grid& grid, const fluid_state& state, double* m);
/// Largest number of rows of formula_maxwellians_on_line().
inline constexpr int most_line_states = 16;
/// Computes at most most_line_states rows of ω in one velocity dimension into rows `pitch` apart, with their
/// states. Returns the number of rows before the first ω that is not admissible.
int formula_maxwellians_on_line(const velocity_grid& grid, const double* omega, int rows, double* m,
                                std::ptrdiff_t pitch, line_state* states);

/// Sufficient condition for the midpoint-rule moments of the formula to equal those of `state` to rounding:
/// Poisson's sum formula bounds their relative error by about 100 exp(−2π²T/Δv²), and the part beyond the
/// grid is of the size exp(−(v_max − |u|)²/(2T)). Returns false for nearly empty space, where values of the
/// formula below 1e-300 would be lost.
bool formula_has_exact_moments(const velocity_grid& grid, const fluid_state& state);
/// The condition in one velocity dimension.
bool formula_has_exact_moments(const velocity_grid& grid, const line_state& state);

/// m ← the minimizer of Σ m log m among all m ≥ 0 with the midpoint-rule moments ω, to round-off: the
/// discrete Maxwellian exp(α + β·v + γ|v|²) (Mieussens, M3AS 10, 2000). On the boundary of the realizable ω
/// it is the limit of these, which is 0 at some points (docs/space.md). It exists for the moments of every f
/// ≥ 0, a row of zeros included; ω may miss the boundary by the rounding of sums. Returns false for other ω;
/// why_unrealizable() has the reason. Sets `of_m`, if given, to the moments of m, or leaves them unknown.
bool discrete_maxwellian(const velocity_grid& grid, const double* omega, double* m,
                         line_moments* of_m = nullptr);
/// The discrete Maxwellian with the moments of a state.
bool discrete_maxwellian(const velocity_grid& grid, const fluid_state& state, double* m);
/// Returns the reason why no row f ≥ 0 has the moments ω, for messages: "temperature -0.3 is not positive";
/// "" if one has.
std::string why_unrealizable(const velocity_grid& grid, const double* omega);

/// Returns the largest difference between the moments of m and `omega`, the moments of `state`, relative to
/// ρ, to ρ(√T + |u_k|) for each momentum, and to 𝓔.
double moment_defect(const velocity_grid& grid, const double* m, const double* omega,
                     const fluid_state& state);

}  // namespace apsis
