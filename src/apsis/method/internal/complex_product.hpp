#pragma once

#include <complex>

namespace apsis {

/// Complex product without the check for infinities of std::complex, which would dominate the run time.
inline std::complex<long double> times(std::complex<long double> a, std::complex<long double> b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

}  // namespace apsis
