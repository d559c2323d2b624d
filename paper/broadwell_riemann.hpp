#pragma once

#include <array>

namespace apsis::paper {

/// Exact solution of the Riemann problem of the Broadwell limit system (paper, eq. broadlimit)
///     ρ_t + m_x = 0,   m_t + ((ρ² + m²)/(2ρ))_x = 0,   (ρ, m) = left for x < 0, right for x > 0.
/// With u = m/ρ the characteristic speeds are λ∓ = (u ∓ √(2 − u²))/2. Through a rarefaction dm/dρ = λ.
/// With u = √2 sin θ, the slow wave therefore has a constant ln ρ + θ + ln(cos θ + sin θ), and the fast
/// wave a constant ln ρ − θ + ln(cos θ − sin θ). A shock obeys s[ρ] = [m] and s[m] = [(ρ² + m²)/(2ρ)], a
/// quadratic equation for the ratio of the densities. Bisection on u finds the state between the two
/// waves. Dimensionless.
class broadwell_riemann {
 public:
  /// The unknowns at one point.
  struct state {
    double rho,  ///< density
        m;       ///< momentum
  };
  /// Throws input_error unless ρ > 0 and |m| < ρ on both sides.
  broadwell_riemann(state left, state right);

  /// Returns the solution on the ray x/t = speed.
  state at(double speed) const;
  /// Returns the state between the two waves.
  state middle() const;
  /// Returns the speeds of the two edges of the slow wave, in increasing order; equal for a shock.
  std::array<double, 2> slow_wave() const;
  /// Returns the speeds of the two edges of the fast wave, in increasing order; equal for a shock.
  std::array<double, 2> fast_wave() const;

 private:
  struct side {
    double rho, u;
  };
  side left_, right_, middle_;
};

}  // namespace apsis::paper
