#include <paper/plateau_study.hpp>

#include <apsis/study/time_study.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <fmt/format.h>

namespace apsis::paper {
namespace {

using numbers = std::vector<double>;

numbers difference(numbers a, const numbers& b) {
  for (std::size_t k = 0; k < a.size(); ++k) a[k] -= b[k];
  return a;
}

/// Returns the factor of b for which the product is nearest to a.
double multiple(const numbers& a, const numbers& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0) /
         std::inner_product(b.begin(), b.end(), b.begin(), 0.0);
}

}  // namespace

std::vector<measured_regime> measure_regimes(const case_config& config,
                                             const std::vector<std::string>& methods, long steps,
                                             const study_control& control) {
  const time_study stiff(config, 1e-6), limit(config, 0.0);
  const field near = stiff.reference(start_data::equilibrium, 1e-11, control);
  const auto near_moments = stiff.moments(near);
  const auto exact_flux =
      difference(near_moments, limit.moments(limit.reference(start_data::equilibrium, 1e-11, control)));
  const auto exact_layer =
      difference(stiff.moments(stiff.reference(start_data::given, 1e-11, control)), near_moments);
  const auto exact_deviation = stiff.deviation(near);

  const auto measure = [&](const method& m, long n) -> measured_regime {
    const field u = stiff.solve(m, n, start_data::equilibrium);
    const auto moments = stiff.moments(u);
    const auto in_limit = limit.moments(limit.solve(m, n, start_data::equilibrium));
    const auto far = stiff.moments(stiff.solve(m, n, start_data::given));
    return {multiple(difference(moments, in_limit), exact_flux),
            multiple(stiff.deviation(u), exact_deviation), multiple(difference(far, moments), exact_layer)};
  };
  std::vector<measured_regime> all;
  for (const auto& name : methods) {
    control.check();
    const auto coarse = measure(find_method(name), steps), fine = measure(find_method(name), 2 * steps);
    all.push_back({2 * fine.flux - coarse.flux, 2 * fine.last - coarse.last, 2 * fine.layer - coarse.layer});
  }
  return all;
}

std::array<double, 2> predicted_ode_plateau(const intermediate_regime<double>& regime, ode_data data) {
  const auto rate = [](double w) { return 1 + w * w; };
  const double u = 2 * std::atan(std::tan(1.0) * std::exp(1.0));  // u' = sin u, u(0) = 2
  const double integral = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
      [&](double w) { return std::cos(w) / (rate(w) * std::sin(w)); }, 2.0, u);
  double first = (1 - regime.flux) * std::sin(u) * integral;
  if (data == ode_data::inconsistent) first += (1 - regime.layer) * std::sin(u) / rate(2.0);
  return {first, std::cos(u) * first + (1 - regime.last) * std::cos(u) * std::sin(u) / rate(u)};
}

std::array<double, 2> measured_ode_plateau(const method& m, ode_data data) {
  using real = long double;
  constexpr real epsilon = 1e-9L;
  const auto exact = ode_reference(static_cast<double>(epsilon), data);
  const real u = 2 * std::atan(std::tan(real(1)) * std::exp(real(1)));
  const ode_state<real> exact_limit{u, std::sin(u)};
  const auto plateau = [&](long steps) {
    const auto with = ode_solution(m, epsilon, steps, data), without = ode_solution(m, real(0), steps, data);
    std::array<double, 2> e{};
    for (std::size_t k = 0; k < 2; ++k)
      e[k] = static_cast<double>(((with[k] - without[k]) - (exact[k] - exact_limit[k])) / epsilon);
    return e;
  };
  const auto coarse = plateau(512), fine = plateau(1024);
  return {2 * fine[0] - coarse[0], 2 * fine[1] - coarse[1]};
}

}  // namespace apsis::paper
