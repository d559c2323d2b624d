#include <apsis/method/linear_formula.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace apsis {

formula_orders compute_formula_orders(const linear_formula<mp_real>& m) {
  const auto defects = [&m](int q) {
    mp_real values(0), transport(0);
    for (int i = 1; i <= m.steps(); ++i) {
      const mp_real x(1 - i);
      values += m.a[static_cast<std::size_t>(i - 1)] * pow(x, q);
      if (q > 0) transport += q * m.c[static_cast<std::size_t>(i - 1)] * pow(x, q - 1);
    }
    return std::pair<mp_real, mp_real>{1 - values - q * m.b, 1 - values - transport};
  };
  constexpr int highest = 12;
  const mp_real tolerance("1e-50");
  formula_orders found;
  mp_real factorial(1);
  for (int q = 0; q <= highest; ++q) {
    factorial *= std::max(q, 1);
    const auto [of_collisions, of_transport] = defects(q);
    const mp_real largest = std::max(mp_real(abs(of_collisions)), mp_real(abs(of_transport)));
    found.implicit_constant = of_collisions / (factorial * m.b);
    found.explicit_constant = of_transport / (factorial * m.b);
    if (largest > tolerance) break;
    found.order = q;
    found.residual = std::max(found.residual, largest);
  }
  return found;
}

double error_amplification(const std::vector<double>& weights) {
  // Roots other than 1 have a modulus below 1 (0.71 for order 5), so that later terms are below rounding.
  constexpr std::size_t most = 4096;
  std::vector<double> response(weights.size(), 0.0);  // h_n, h_{n−1}, …
  response.front() = 1.0;
  double sum = 1.0;
  for (std::size_t n = 1; n < most; ++n) {
    double next = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) next += weights[i] * response[i];
    sum += std::abs(next - response.front());
    std::rotate(response.rbegin(), response.rbegin() + 1, response.rend());
    response.front() = next;
  }
  return sum;
}

}  // namespace apsis
