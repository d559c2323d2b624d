#pragma once

#include <apsis/method/certificate.hpp>
#include <apsis/method/tableau.hpp>

#include <complex>

namespace apsis {

/// Evaluates R(z) of the implicit part by forward substitution.
std::complex<long double> stability_function(const butcher_form<long double>& b, std::complex<long double> z);

/// Computes the poles on the imaginary axis, the range of R on the negative axis, and the angle of
/// A(α)-stability. The angle is proved (stable_ray.hpp): rounded down to 10⁻⁴ degrees, or exactly 90. The
/// range on the negative axis is sampled at 40 points per decade and refined around each extremum.
implicit_stability analyse_stability(const shu_osher_form<long double>& m);

}  // namespace apsis
