#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/method/linear_formula.hpp>

#include <string>

namespace apsis {

/// Returns IMEX-BDF of order k: the backward differentiation formula Σ_{j=1}^k ∇^j u^{n+1}/j = Δt (T +
/// Q)^{n+1} with T extrapolated, T^{n+1} ≈ Σ_i (−1)^{i−1} C(k,i) T^{n+1−i}. Uniformly accurate in ε for data
/// near equilibrium (Hu, Shu, Math. Comp. 90 (2021) 641–670); k = 2 … 5 are the formulas SBDF (Ascher, Ruuth,
/// Wetton, SIAM J. Numer. Anal. 32 (1995) 797–823). Signs are not preserved: some a_i and c_i are negative
/// for k ≥ 2. Throws input_error unless 1 ≤ k ≤ 5.
template <class Real>
linear_formula<Real> imex_bdf_coefficients(int k) {
  if (k < 1 || k > 5)
    throw input_error("there is no IMEX-BDF method of order " + std::to_string(k) +
                      " here (its orders are 1 to 5); choose one of these");
  linear_formula<Real> m;
  Real leading(0);  // of u^{n+1}
  for (int j = 1; j <= k; ++j) leading += Real(1) / Real(j);
  const auto binomial = [](int n, int i) {
    Real product(1);
    for (int l = 1; l <= i; ++l) product = product * Real(n + 1 - l) / Real(l);
    return product;
  };
  for (int i = 1; i <= k; ++i) {
    const Real sign(i % 2 == 0 ? -1 : 1);
    Real sum(0);
    for (int j = i; j <= k; ++j) sum += binomial(j, i) / Real(j);
    m.a.push_back(sign * sum / leading);
    m.c.push_back(sign * binomial(k, i) / leading);
  }
  m.b = Real(1) / leading;
  return m;
}

}  // namespace apsis
