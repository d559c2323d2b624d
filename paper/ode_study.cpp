#include <paper/ode_study.hpp>

namespace apsis::paper {

ode_state<long double> ode_reference(double epsilon, ode_data data, extrapolation_options<long double> how) {
  auto problem = ode_problem(static_cast<long double>(epsilon));
  auto u = ode_initial(data, static_cast<long double>(epsilon));
  extrapolate(problem, u, 0.0L, 1.0L, how,
              [](const auto& a, const auto& b) { return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]); });
  return u;
}

double halving_slope(const std::vector<double>& values) {
  const double n = static_cast<double>(values.size()), middle = (n - 1) / 2;
  double product = 0, square = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double x = middle - static_cast<double>(k);
    product += x * std::log2(values[k]);
    square += x * x;
  }
  return product / square;
}

}  // namespace apsis::paper
