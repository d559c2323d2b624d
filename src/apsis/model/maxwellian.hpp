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

/// omega ← the d + 2 moments (ρ, ρu, 𝓔) of a row of grid.size() values, by the quadrature of the grid.
void kinetic_moments(const velocity_grid& grid, const double* f, double* omega);
/// omega ← the moments of several rows, which lie `pitch` numbers apart, one ω after the other.
void kinetic_moments(const velocity_grid& grid, const double* f, std::ptrdiff_t pitch, int rows,
                     double* omega);

/// Returns the last direction of a grid. Its weights are those to combine with grid.functions_of_lines().
grid_sums::axis last_axis(const velocity_grid& grid);
/// Returns the density ρ of a row, its first moment.
double kinetic_mass(const velocity_grid& grid, const double* f);

/// A fluid_state of one velocity dimension, without unused components.
struct line_state {
  double rho,  ///< density
      u,       ///< bulk velocity
      T;       ///< temperature
  /// Whether all values are finite, ρ > 0 and T > 0.
  bool admissible() const { return rho > 0.0 && T > 0.0 && std::isfinite(rho + std::abs(u) + T); }
};

/// m ← rows of Gaussians at the points of a line, which lie `pitch` numbers apart. Values below 1e-300
/// become 0.
void gaussians_on(const velocity_line& line, const velocity_rows::gaussian* of_rows, int rows, double* m,
                  std::ptrdiff_t pitch);

/// m ← M[ρ, u, T](v) = ρ (2πT)^{−d/2} exp(−|v − u|²/(2T)) at the grid points (paper, after eq. BGK).
void formula_maxwellian(const velocity_grid& grid, const fluid_state& state, double* m);
/// Largest number of rows of formula_maxwellians_on_line().
inline constexpr int most_line_states = 16;
/// m ← the Maxwellians by formula of at most most_line_states moments ω in one velocity dimension, in rows
/// that lie `pitch` numbers apart. states ← the states of these ω. Returns the number of rows before the
/// first ω that is not admissible.
int formula_maxwellians_on_line(const velocity_grid& grid, const double* omega, int rows, double* m,
                                std::ptrdiff_t pitch, line_state* states);

/// Returns true if the midpoint-rule moments of the formula equal those of `state` to rounding, by a
/// sufficient condition. Poisson's sum formula bounds their relative error by about 100 exp(−2π²T/Δv²). The
/// part beyond the grid has the size exp(−(v_max − |u|)²/(2T)). Returns false in nearly empty space, where
/// values of the formula below 1e-300 would be lost.
bool formula_has_exact_moments(const velocity_grid& grid, const fluid_state& state);
/// Checks the same condition in one velocity dimension.
bool formula_has_exact_moments(const velocity_grid& grid, const line_state& state);

/// m ← the minimizer of Σ m log m among all m ≥ 0 with the moments ω, to rounding. This is the discrete
/// Maxwellian exp(α + β·v + γ|v|²) (Mieussens, M3AS 10, 2000). On the boundary of the realizable ω it is a
/// limit of such functions, which is 0 at some points (docs/space.md).
///
/// The discrete Maxwellian exists for the moments of every f ≥ 0, including f = 0. ω may lie beyond the
/// boundary by the rounding of sums. Returns false for other ω; why_unrealizable() returns the reason. Sets
/// `of_m`, if given, to the central moments of m, or leaves them unknown.
bool discrete_maxwellian(const velocity_grid& grid, const double* omega, double* m,
                         line_moments* of_m = nullptr);
/// m ← the discrete Maxwellian with the moments of a state.
bool discrete_maxwellian(const velocity_grid& grid, const fluid_state& state, double* m);
/// Returns the reason why no row f ≥ 0 has the moments ω, for messages: "temperature -0.3 is not positive".
/// Returns "" if such a row exists.
std::string why_unrealizable(const velocity_grid& grid, const double* omega);

/// Returns the largest relative difference between the moments of m and `omega`, the moments of `state`.
/// Differences are relative to ρ for the density, to ρ(√T + |u_k|) for momentum k, and to 𝓔 for the energy.
double moment_defect(const velocity_grid& grid, const double* m, const double* omega,
                     const fluid_state& state);

}  // namespace apsis
