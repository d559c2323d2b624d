#include <apsis/method/multistep.hpp>

#include <apsis/core/suggest.hpp>
#include <apsis/method/method_file.hpp>
#include <apsis/method/two_step.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

const std::string bdf_prefix = "imex-bdf-";
constexpr int highest_bdf = 5;

/// Returns k of the name "imex-bdf-k"; 0 for other names.
int bdf_order(const std::string& name) {
  for (int k = 1; k <= highest_bdf; ++k)
    if (name == bdf_prefix + std::to_string(k)) return k;
  return 0;
}

/// The rows u^{n−k+1} … u^{n−1} and u^{n+1}, without transport.
shu_osher_form<double> rows_of(const multistep_coefficients<double>& m) {
  const auto earlier = m.a.size() - 1, rows = earlier + 1;
  shu_osher_form<double> form{matrix<double>(rows, rows), matrix<double>(rows, rows),
                              matrix<double>(rows, rows), std::vector<double>(rows), 1.0};
  for (std::size_t j = 0; j < earlier; ++j) form.P(earlier, j) = m.a[earlier - j];
  form.D(earlier, earlier) = m.b;
  return form;
}

multistep_method imex_bdf_of(int k) {
  const auto formula = imex_bdf_coefficients<double>(k);
  multistep_method m;
  m.name = bdf_prefix + std::to_string(k);
  m.title = fmt::format("IMEX backward differentiation formula of order {}", k);
  m.starter = k == 1 ? "forward-backward-euler" : fmt::format("extrapolated-euler-{}", k);
  m.order = m.steps = k;
  if (k == 1) m.ssp_coefficient = 1.0;  // implicit-explicit Euler; others have negative weights
  m.weights = formula.a;
  m.form = rows_of(formula);
  return m;
}

multistep_method two_steps_of(method found) {
  multistep_method m;
  m.name = found.name;
  m.title = found.title;
  m.order = found.claims.order;
  m.steps = 2;
  m.form = found.coefficients<double>();
  m.stages = found.stages() - 1;
  // The first steps may be of one order less. The first of these methods has the right terms of size epsilon
  // and is SSP up to r = 1.25; those of higher order are not SSP.
  const bool has_ssp_starter = m.order <= 4;
  m.starter = has_ssp_starter ? "md-imex-10-3-mixed" : fmt::format("extrapolated-euler-{}", m.order);
  if (has_ssp_starter)
    m.ssp_coefficient = std::min(m.form.r, find_method(m.starter).coefficients<double>().r);
  const double previous = weight_of_previous(m.form);
  m.weights = {1.0 - previous, previous};
  m.rows = std::move(found);
  return m;
}

}  // namespace

multistep_orders find_multistep_orders(const multistep_coefficients<mp_real>& m) {
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
  multistep_orders found;
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

multistep_method find_multistep_method(const std::string& name) {
  if (const int k = bdf_order(name); k > 0) return imex_bdf_of(k);
  if (is_method_file(name) || is_two_step_method(name)) return two_steps_of(find_two_step_method(name));
  throw input_error(fmt::format("unknown multistep method '{}'; {}", name.substr(0, 60),
                                suggest(name, multistep_method_names())));
}

bool is_multistep_method(const std::string& name) {
  return bdf_order(name) > 0 || is_two_step_method(name);
}

std::vector<std::string> multistep_method_names() {
  std::vector<std::string> names;
  for (int k = 1; k <= highest_bdf; ++k) names.push_back(bdf_prefix + std::to_string(k));
  for (auto& name : two_step_method_names()) names.push_back(std::move(name));
  return names;
}

std::vector<std::string> all_method_names() {
  auto names = method_names();
  for (auto& name : multistep_method_names()) names.push_back(std::move(name));
  return names;
}

int order_of_method(const std::string& name) {
  return is_multistep_method(name) ? find_multistep_method(name).order : find_method(name).claims.order;
}

double error_amplification(const std::vector<double>& weights) {
  // Roots other than 1 have a modulus below 1, 0.71 for order 5; later terms are below the rounding.
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
