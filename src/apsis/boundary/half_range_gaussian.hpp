#pragma once

#include <optional>

namespace apsis {

/// A Gaussian restricted to half of the velocities of a gas. Dimensionless.
struct half_range_gaussian {
  double drift = 0.0;     ///< a: velocity towards the wall, divided by σ
  double variance = 1.0;  ///< σ², along one axis
};

/// Returns the Gaussian exp(−|v − u|²/(2σ²)), u = −aσ n, of d velocity dimensions with two given mean values.
/// Both are means over the particles that cross a plane: `z` of |v·n| > 0, and `square` of |v|². With I_p(a)
/// = ∫_0^∞ x^p φ(x − a) dx and the normal density φ the Gaussian solves
///     square/z² = (d − 1 + I_3/I_1) (I_1/I_2)²,   σ² = square/(d − 1 + I_3/I_1)
/// with a table of a between −4 and 24, to 1 %. Returns nothing if square/z² is outside the table.
std::optional<half_range_gaussian> gaussian_of_fluxes(double z, double square, int dimensions);

}  // namespace apsis
