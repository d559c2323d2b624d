#pragma once

#include <algorithm>

namespace apsis {

/// Weights of the convex combination v = stay·u + relax·E that solves v = u + a Q(v) + b Q̇(v) for a
/// relaxation Q(u) = C (E − u)/ε with conserved moments. Nonnegative, and stay + relax rounds to 1.
template <class Real>
struct relaxation_weights {
  Real stay,  ///< of u
      relax;  ///< of E
};

/// stay = 1/(1 + μ), relax = μ/(1 + μ), μ = a C/ε + |b| (C/ε)², because there Q̇ = −(C/ε) Q (paper,
/// Property 5 and eq. AP1). All arguments are dimensionless and nonnegative but b, which is ≤ 0: a = Δt d,
/// b = Δt² ḋ, `rate` = C, `epsilon` = ε. Each weight is good to an ulp or so, however small it is.
/// μ = ∞ (ε = 0, or (C/ε)² beyond the range of Real) gives exactly {0, 1}; a = b = 0 gives exactly {1, 0},
/// also for ε = 0. A NaN in the arguments comes out as NaN. No branch, so that loops over it vectorise.
template <class Real>
constexpr relaxation_weights<Real> relax_weights(Real a, Real b, Real rate, Real epsilon) {
  const Real k = rate > Real(0) || rate != rate ? rate / epsilon : Real(0);  // no 0/0 where nothing relaxes
  const Real first = a == Real(0) ? Real(0) : a * k;                         // no 0·∞ for ε = 0
  const Real second = b == Real(0) ? Real(0) : -b * k * k;
  const Real mu = first + second;
  // The smaller weight by division, the larger as what is missing to 1: neither cancels.
  const Real smaller = std::min(mu, Real(1)) / (Real(1) + mu);
  const Real larger = Real(1) - smaller;
  return mu <= Real(1) ? relaxation_weights<Real>{larger, smaller}
                       : relaxation_weights<Real>{smaller, larger};
}

}  // namespace apsis
