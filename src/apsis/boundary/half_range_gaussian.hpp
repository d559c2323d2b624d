#pragma once

#include <optional>

namespace apsis {

/// A Gaussian of half of the velocities of a gas. Dimensionless.
struct half_range_gaussian {
  double drift = 0.0;     ///< a: velocity towards the wall over the thermal velocity
  double variance = 1.0;  ///< σ²
};

/// Returns the Gaussian exp(−|v − u|²/(2σ²)) of d velocity dimensions, u = −aσ n, with two mean values of the
/// particles that cross a plane: z = |v·n| > 0, and `square` of |v|². With I_p(a) = ∫_0^∞ x^p φ(x − a) dx of
/// the normal density φ it solves
///     square/z² = (d − 1 + I_3/I_1) (I_1/I_2)²,   σ² = square/(d − 1 + I_3/I_1)
/// by a table of a, to 1 % between −4 and 24. Returns nothing where square/z² is outside.
std::optional<half_range_gaussian> gaussian_of_fluxes(double z, double square, int dimensions);

}  // namespace apsis
