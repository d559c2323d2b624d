#pragma once

#include <apsis/core/aligned.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Midpoint velocity grid on [−max, max]^d, d = 1, 2, 3, the first direction slowest.
class velocity_grid {
 public:
  /// Throws input_error unless 1 ≤ d ≤ 3, points ≥ 4 and max > 0.
  velocity_grid(int dimensions, int points, double max);

  int dimensions() const { return dimensions_; }
  int points() const { return points_; }  ///< per direction
  int size() const { return size_; }      ///< points^d
  double max() const { return max_; }
  double spacing() const { return spacing_; }                   ///< Δv
  double weight() const { return weight_; }                     ///< Δv^d
  const aligned_vector<double>& line() const { return line_; }  ///< the points of one direction
  /// Component k of the velocity of every grid point.
  const aligned_vector<double>& component(int k) const { return components_[static_cast<std::size_t>(k)]; }
  /// ½|v|² of every grid point.
  const aligned_vector<double>& half_square() const { return half_square_; }

 private:
  int dimensions_, points_, size_ = 1;
  double max_, spacing_, weight_;
  aligned_vector<double> line_, half_square_;
  std::vector<aligned_vector<double>> components_;
};

/// ω = (ρ, ρu_1 … ρu_d, 𝓔) with 𝓔 = ½ρ|u|² + (d/2)ρT, and the state it stands for. Dimensionless.
struct fluid_state {
  double rho = 0.0;
  double u[3] = {0.0, 0.0, 0.0};
  double T = 0.0;
  bool admissible() const;  ///< all finite, ρ > 0 and T > 0
};
fluid_state to_fluid_state(const double* omega, int dimensions);

/// Midpoint-rule moments (ρ, ρu, 𝓔) of a row of grid values.
void kinetic_moments(const velocity_grid& grid, const double* f, double* omega);

/// M[ρ, u, T](v) = ρ (2πT)^{−d/2} exp(−|v − u|²/(2T)) at the grid points (paper, after eq. BGK).
void formula_maxwellian(const velocity_grid& grid, const fluid_state& state, double* m);

/// Sufficient for its midpoint-rule moments to be those of `state` to round-off: Poisson's sum formula bounds
/// their relative error by about 100 exp(−2π²T/Δv²), and what lies beyond the grid is of the size exp(−(v_max
/// − |u|)²/(2T)).
bool formula_has_exact_moments(const velocity_grid& grid, const fluid_state& state);

/// exp(α + β·v + γ|v|²) whose midpoint-rule moments are those of `state` to round-off, on any grid
/// (Mieussens, M3AS 10, 2000). Newton's method on the convex dual, damped. False if the grid has no such
/// function (too coarse for √T, or u near its edge).
bool discrete_maxwellian(const velocity_grid& grid, const fluid_state& state, double* m);

/// Largest defect of the moments of m against `omega`, relative to (ρ, ρ√T, ρT) as fits.
double moment_defect(const velocity_grid& grid, const double* m, const double* omega,
                     const fluid_state& state);

}  // namespace apsis
