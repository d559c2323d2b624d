#include <apsis/verify/ode_model.hpp>

namespace apsis {

ode_state<long double> ode_reference(double epsilon, ode_data data, extrapolation_options<long double> how) {
  auto problem = ode_problem(static_cast<long double>(epsilon));
  auto u = ode_initial(data, static_cast<long double>(epsilon));
  extrapolate(problem, u, 0.0L, 1.0L, how,
              [](const auto& a, const auto& b) { return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]); });
  return u;
}

}  // namespace apsis
