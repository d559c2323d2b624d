#pragma once

namespace apsis {

/// Primitive variables of the moments ω = (ρ, ρu_1 … ρu_d, 𝓔) with 𝓔 = ½ρ|u|² + (d/2)ρT. Dimensionless. This
/// header includes nothing, because kernels of devices use it.
struct fluid_state {
  double rho = 0.0;               ///< density ρ
  double u[3] = {0.0, 0.0, 0.0};  ///< bulk velocity; 0 from component d on
  double T = 0.0;                 ///< temperature; the pressure is ρT
  /// Whether all values are finite, ρ > 0 and T > 0.
  constexpr bool admissible() const {
    const double speeds = u[0] + u[1] + u[2];
    return rho - rho == 0.0 && speeds - speeds == 0.0 && T - T == 0.0 && rho > 0.0 && T > 0.0;
  }
  /// Returns ρ (2πT)^{−d/2}, the largest value of the Maxwellian.
  double height(int dimensions) const {
    const double of_one_direction = 1.0 / __builtin_sqrt(2.0 * 3.14159265358979323846 * T);
    double factor = rho;
    for (int k = 0; k < dimensions; ++k) factor *= of_one_direction;
    return factor;
  }
};
/// Returns the primitive variables of d + 2 moments ω. Does not check that they are admissible: ρ = 0 gives
/// NaN or ±∞.
constexpr fluid_state to_fluid_state(const double* omega, int dimensions) {
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

}  // namespace apsis
