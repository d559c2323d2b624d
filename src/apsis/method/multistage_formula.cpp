#include <apsis/method/multistage_formula.hpp>

#include <algorithm>

namespace apsis {
namespace {

/// Returns the largest defect of the conditions of order k.
mp_real defect_of(const multistage_formula<mp_real>& m, const matrix<mp_real>& A, const matrix<mp_real>& B,
                  int k) {
  const auto q = taylor_coefficients(m.c, A, k);
  mp_real largest(0);
  for (std::size_t i = 0; i < m.stages(); ++i) {
    mp_real rest = required_moments(m.v, q, i, k).back();
    for (std::size_t j = 0; j < m.stages(); ++j) {
      mp_real power(1);  // c_j^{k−1}/(k − 1)!
      for (int e = 1; e < k; ++e) power *= m.c[j] / e;
      rest -= B(i, j) * power;
    }
    largest = std::max(largest, mp_real(abs(rest)));
  }
  return largest;
}

/// Returns |1 − Σ v_j| + |1 − c_s|: the condition of order 0, and u^{n+1} at t_{n+1}.
mp_real defect_of_values(const multistage_formula<mp_real>& m) {
  mp_real rest(1);
  for (const auto& weight : m.v) rest -= weight;
  return abs(rest) + abs(mp_real(1 - m.c.back()));
}

}  // namespace

multistage_orders compute_multistage_orders(const multistage_formula<mp_real>& m) {
  const mp_real tolerance("1e-45");  // of rational functions of coefficients with 45 digits
  constexpr int highest = 12;
  multistage_orders found;
  found.residual = defect_of_values(m);
  if (found.residual > tolerance) return found;
  for (int k = 1; k <= highest; ++k) {
    found.implicit_constant = defect_of(m, m.A, m.B, k);
    found.explicit_constant = defect_of(m, m.A_hat, m.B_hat, k);
    const mp_real largest = std::max(found.implicit_constant, found.explicit_constant);
    if (largest > tolerance) break;
    found.order = k;
    found.residual = std::max(found.residual, largest);
  }
  return found;
}

}  // namespace apsis
