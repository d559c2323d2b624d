#pragma once

#include <apsis/exec/aligned.hpp>
#include <apsis/model/velocity_line.hpp>
#include <apsis/model/velocity_rows.hpp>
#include <apsis/phase/velocity_set.hpp>

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// All combinations of the velocities of d = 1, 2, 3 lines, the first direction slowest, with the products of
/// their weights.
class velocity_grid {
 public:
  /// Largest number of velocities, such that kernels can count them in int.
  static constexpr int most_velocities = 1 << 30;

  /// Midpoints of equal intervals, the same in all directions. Throws input_error unless 1 ≤ d ≤ 3, points ≥
  /// 4, points^d ≤ most_velocities and max > 0.
  velocity_grid(int dimensions, int points, double max);
  /// Throws input_error unless there are 1 to 3 lines and at most most_velocities combinations.
  explicit velocity_grid(std::vector<velocity_line> lines);

  /// Throws input_error if lines of these lengths have more than most_velocities combinations.
  static void check_size(std::span<const int> points);

  int dimensions() const { return static_cast<int>(lines_.size()); }  ///< d
  int size() const { return size_; }                                  ///< number of velocities
  /// Returns the velocities of a direction.
  const velocity_line& line(int k) const { return lines_[static_cast<std::size_t>(k)]; }
  /// Returns those of the last direction, along which velocities are contiguous.
  const velocity_line& last_line() const { return lines_.back(); }
  /// Returns the number of lines in the last direction, size()/last_line().points().
  int lines() const { return size_ / last_line().points(); }
  /// Returns component k < d − 1 of the velocities of every line in the last direction.
  const double* component_of_lines(int k) const { return of_lines_[static_cast<std::size_t>(k)].data(); }
  /// Whether all lines are uniform. The weights are then equal.
  bool uniform() const { return uniform_; }
  double weight() const { return weight_; }  ///< Δv_1 ⋯ Δv_d, or 1 if not uniform
  double max() const;                        ///< the largest of all lines
  double unit() const { return unit_; }      ///< smallest spacing of all lines, the unit of their places()
  /// row ← w ∘ f, which sums with weight(); f itself if uniform.
  const double* weighted(const double* f, aligned_vector<double>& row) const;
  /// Returns component k of the velocity of every grid point.
  std::span<const double> component(int k) const { return set_.speeds(k); }
  /// Returns the velocities with their weights.
  const velocity_set& set() const { return set_; }
  /// Returns ½|v|² of every grid point.
  const aligned_vector<double>& half_square() const { return half_square_; }

 private:
  std::vector<velocity_line> lines_;
  int size_ = 1;
  bool uniform_ = true;
  double weight_ = 1.0, unit_ = 0.0;
  aligned_vector<double> half_square_;
  std::vector<std::vector<double>> of_lines_;
  velocity_set set_;
};

/// Primitive variables of the moments ω = (ρ, ρu_1 … ρu_d, 𝓔) with 𝓔 = ½ρ|u|² + (d/2)ρT. Dimensionless.
struct fluid_state {
  double rho = 0.0;               ///< density ρ
  double u[3] = {0.0, 0.0, 0.0};  ///< bulk velocity; 0 from component d on
  double T = 0.0;                 ///< temperature, in units in which the pressure is ρT
  /// Whether all values are finite, ρ > 0 and T > 0.
  bool admissible() const {
    return std::isfinite(rho) && std::isfinite(u[0] + u[1] + u[2]) && std::isfinite(T) && rho > 0.0 &&
           T > 0.0;
  }
};
/// Returns the primitive variables of d + 2 moments ω without checking that they are admissible: ρ = 0 gives
/// NaN or ±∞.
inline fluid_state to_fluid_state(const double* omega, int dimensions) {
  fluid_state s;
  s.rho = omega[0];
  double square = 0.0;
  for (int k = 0; k < dimensions; ++k) {
    s.u[k] = omega[1 + k] / s.rho;
    square += s.u[k] * s.u[k];
  }
  s.T = (2.0 * omega[1 + dimensions] / s.rho - square) / dimensions;
  return s;
}

/// omega ← the d + 2 midpoint-rule moments (ρ, ρu, 𝓔) of a row of grid.size() values.
void kinetic_moments(const velocity_grid& grid, const double* f, double* omega);
/// The moments of several rows, `pitch` numbers apart, one ω after the other.
void kinetic_moments(const velocity_grid& grid, const double* f, std::ptrdiff_t pitch, int rows,
                     double* omega);

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
/// The same for at most most_line_states rows of ω in one velocity dimension, into rows `pitch` apart, with
/// their states. Returns the number of rows before the first ω that is not admissible.
int formula_maxwellians_on_line(const velocity_grid& grid, const double* omega, int rows, double* m,
                                std::ptrdiff_t pitch, line_state* states);

/// Sufficient condition for the midpoint-rule moments of the formula to equal those of `state` to rounding:
/// Poisson's sum formula bounds their relative error by about 100 exp(−2π²T/Δv²), and what lies beyond the
/// grid is of the size exp(−(v_max − |u|)²/(2T)). False for nearly empty space, where the formula would lose
/// values below 1e-300.
bool formula_has_exact_moments(const velocity_grid& grid, const fluid_state& state);
/// The condition in one velocity dimension.
bool formula_has_exact_moments(const velocity_grid& grid, const line_state& state);

/// m ← the minimizer of Σ m log m among all m ≥ 0 with the midpoint-rule moments ω, to round-off: the
/// discrete Maxwellian exp(α + β·v + γ|v|²) (Mieussens, M3AS 10, 2000), and where ω lies on the boundary of
/// what m ≥ 0 can have, its limit, which is 0 at some points (docs/space.md). Exists for the moments of every
/// f ≥ 0, a row of zeros included; ω may miss the boundary by the rounding of sums. False for other ω, for
/// which why_unrealizable() has the reason.
bool discrete_maxwellian(const velocity_grid& grid, const double* omega, double* m);
/// The discrete Maxwellian with the moments of a state.
bool discrete_maxwellian(const velocity_grid& grid, const fluid_state& state, double* m);
/// Returns the reason why no row f ≥ 0 has the moments ω, for messages: "temperature -0.3 is not positive";
/// "" if one has.
std::string why_unrealizable(const velocity_grid& grid, const double* omega);

/// Returns the largest defect of the moments of m against `omega`, the moments of `state`; relative to ρ, to
/// ρ(√T + |u_k|) for each momentum, and to 𝓔.
double moment_defect(const velocity_grid& grid, const double* m, const double* omega,
                     const fluid_state& state);

}  // namespace apsis
