#pragma once

#include <complex>

namespace apsis {

/// Complex product without the check for infinities of std::complex, which would dominate the run time.
template <class Real>
std::complex<Real> times(std::complex<Real> a, std::complex<Real> b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

}  // namespace apsis
