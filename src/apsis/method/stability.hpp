#pragma once

#include <apsis/method/certificate.hpp>
#include <apsis/method/tableau.hpp>

#include <complex>

namespace apsis {

/// R(z) of the implicit part by forward substitution.
std::complex<long double> stability_function(const butcher_form<long double>& b, std::complex<long double> z);

/// Poles on the imaginary axis, behaviour on the negative axis, and the angle of A(α)-stability, sampled on
/// rays with 40 radii per decade.
implicit_stability analyse_stability(const butcher_form<long double>& b);

}  // namespace apsis
