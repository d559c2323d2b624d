#pragma once

#include <apsis/method/tableau.hpp>

namespace apsis {

/// Proves |R(z)| ≤ 1 on the ray z = −t e^{−iα}, 0 ≤ t ≤ ∞, where α is given in degrees, 0 ≤ α < 90. R(z) is
/// that of y' = λy, z = λΔt. The ray is bisected into intervals. On each interval, discs of the complex plane
/// enclose R and dR/dt. Then 1 − |R|² ≥ 0 follows from its value at the midpoint and the range of its
/// derivative. Returns false if a point with |R| > 1 is found, or if 200 000 intervals or a relative length
/// of 10⁻¹² do not suffice for a proof. An allowance of 10⁻¹⁴ for |R|² covers rounding of long double, about
/// 10⁻¹⁷.
bool is_stable_ray(const shu_osher_form<long double>& m, long double degrees);

/// Proves |R(iy)| ≤ 1 for all real y. With R = N/D, the difference |D(iy)|² − |N(iy)|² is a polynomial in y²,
/// computed in 60 digits. Coefficients below 10⁻¹⁵ of the cancelling terms count as zero. The polynomial is
/// nonnegative if its Bernstein coefficients are, after bisection where necessary. Returns false if it is
/// negative somewhere or if the proof fails.
bool is_stable_imaginary_axis(const shu_osher_form<long double>& m);

}  // namespace apsis
