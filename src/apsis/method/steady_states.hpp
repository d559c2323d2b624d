#pragma once

#include <apsis/method/tableau.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace apsis {

/// Returns max_i max(|ĉ_i − c_i|, |ċ_i|) of the row sums ĉ, c, ċ of Â, A and Ȧ. If it is 0, a method leaves a
/// steady state of u' = T(u) + Q(u)/ε unchanged for any Δt: with u_j = u and T(u) = −Q(u)/ε, stage i is u +
/// Δt (ĉ_i − c_i) T(u) + Δt² ċ_i Q̇(u)/ε². Otherwise its steady states depend on Δt/ε. Coefficients of Q̇ in
/// SSP methods have one sign, so that the value 0 excludes Q̇.
template <class Real>
Real steady_state_defect(const butcher_form<Real>& m) {
  using std::abs;
  Real largest{};
  for (std::size_t i = 0; i < m.stages(); ++i) {
    Real difference{}, second{};
    for (std::size_t j = 0; j < m.stages(); ++j) {
      difference += m.A_hat(i, j) - m.A(i, j);
      second += m.A_dot(i, j);
    }
    largest = std::max({largest, Real(abs(difference)), Real(abs(second))});
  }
  return largest;
}

}  // namespace apsis
