#pragma once

#include <apsis/integrate/ensemble.hpp>
#include <apsis/integrate/newton_problem.hpp>
#include <apsis/method/time_integrator.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace ensemble_test {

using numbers = std::vector<double>;
using tolerances = apsis::component_tolerances<double>;

/// Robertson's reaction, with its three rates as parameters.
constexpr auto robertson = [](double, auto y, auto k, auto f) {
  f[0] = k[1] * y[1] * y[2] - k[0] * y[0];
  f[2] = k[2] * y[1] * y[1];
  f[1] = -f[0] - f[2];
};
constexpr std::array<double, 3> rates = {0.04, 1e4, 3e7};

/// Solves a single system, with automatic derivatives of another kind, and Newton's method up to rounding.
inline numbers robertson_alone(const numbers& k, double t1, double tolerance) {
  apsis::newton_problem problem(apsis::no_transport{}, [&k](const auto& y, auto& f) {
    f[0] = k[1] * y[1] * y[2] - k[0] * y[0];
    f[2] = k[2] * y[1] * y[1];
    f[1] = -1.0 * f[0] - f[2];
  });
  const auto& m = apsis::find_method("imdrk-9-5-accurate");
  apsis::stepper march(m, problem, apsis::solutions::result_and_embedded);
  apsis::step_controller<double> control(1.0, apsis::estimate_of(m).order);
  numbers u{1, 0, 0};
  apsis::integrate_to_tolerance(
      march, u, 0.0, t1, apsis::step_rule<double>::unlimited(), control,
      tolerances({tolerance}, {tolerance * 1e-4, tolerance * 1e-8, tolerance * 1e-4}));
  return u;
}

inline tolerances of_robertson(double tolerance) {
  return tolerances({tolerance}, {tolerance * 1e-4, tolerance * 1e-8, tolerance * 1e-4});
}

/// Systems whose rates grow by one percent from each to the next.
struct robertson_ensemble {
  explicit robertson_ensemble(std::size_t systems) {
    for (std::size_t s = 0; s < systems; ++s) {
      u.insert(u.end(), {1, 0, 0});
      for (const double k : rates) parameters.push_back(k * (1 + 0.01 * static_cast<double>(s)));
    }
  }
  /// `steps` is a method or linearly_implicit.
  template <class Steps>
  apsis::ensemble_counts advance(const Steps& steps, double t1, double tolerance) {
    return apsis::integrate_ensemble<3, 3>(steps, apsis::no_lane_transport{}, robertson, u, parameters, 0.0,
                                           t1, of_robertson(tolerance));
  }
  numbers u, parameters;
};

}  // namespace ensemble_test
