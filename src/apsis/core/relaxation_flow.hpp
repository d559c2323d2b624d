#pragma once

#include <apsis/core/relaxation_weights.hpp>

#include <cmath>

namespace apsis {

/// Computes the weights of u and E in v(s) = e^{−z} u + (1 − e^{−z}) E, z = sC/ε. This v solves v' = C (E −
/// v)/ε, v(0) = u, with constant E and C. All arguments are dimensionless and nonnegative: `time` = s,
/// `rate` = C, `epsilon` = ε. Each weight is accurate to about an ulp, however small. ε = 0 gives exactly
/// {0, 1}; s = 0 or C = 0 gives exactly {1, 0}, even for ε = 0. NaN arguments give NaN weights, except if s
/// = 0 or C = 0.
template <class Real>
relaxation_weights<Real> flow_weights(Real time, Real rate, Real epsilon) {
  if (time == Real(0) || rate == Real(0)) return {Real(1), Real(0)};
  using std::exp, std::expm1;
  const Real z = time * (rate / epsilon);
  // Computes the smaller weight, and the larger one by subtraction from 1. Both are accurate, and their sum
  // rounds to 1.
  if (z < Real(0.6875)) {  // ln 2 is 0.693…
    const Real of_e = -expm1(-z);
    return {Real(1) - of_e, of_e};
  }
  const Real of_u = exp(-z);
  return {of_u, Real(1) - of_u};
}

}  // namespace apsis
