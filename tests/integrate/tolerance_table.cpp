// Runs to tolerances from 1e-3 to 1e-9 with epsilon from 1 to 1e-10: steps, errors and their forecasts.
#include "support/catalogue.hpp"

#include <apsis/integrate/tolerance_forecast.hpp>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <integrate/ode_model.hpp>
#include <integrate/reference.hpp>

namespace tolerance_table_test {

namespace {

using state = std::vector<double>;

const auto distance = [](const state& u, const state& v) {
  return std::hypot(u[0] - v[0], u[1] - v[1]) / std::hypot(u[0], u[1]);
};

struct outcome {
  long steps;
  double error,  ///< at t = 1, relative
      forecast;  ///< forecast of the error of the O(ε) terms
};

/// The ODE model of the paper from data out of equilibrium.
outcome run_to(const apsis::method& m, double epsilon, double tolerance) {
  static std::map<double, reference::pair> exact;
  if (!exact.contains(epsilon)) exact[epsilon] = reference::radau(epsilon, 1);
  auto problem = ode_model::as_relaxation<state>(epsilon);
  apsis::stepper march(m, problem, apsis::solutions::result_and_embedded);
  apsis::step_controller<double> control(tolerance, m.embedded->order);
  auto u = ode_model::initial_state<state>();
  const auto bounds = apsis::find_plateau_bounds(apsis::to_butcher(m.coefficients<double>()));
  const auto expected =
      apsis::forecast_tolerance(march, 0.0, u, 1.0, 1.0, control.target(), bounds, distance);
  const auto done = apsis::integrate_to_tolerance(march, u, 0.0, 1.0, apsis::step_rule<double>::unlimited(),
                                                  control, distance);
  const auto& solution = exact[epsilon];
  return {done.steps, distance(u, {static_cast<double>(solution[0]), static_cast<double>(solution[1])}),
          expected.error};
}

/// A decade of the tolerance costs at most a factor of 30. The error exceeds the tolerance by more than a
/// constant of the method only where that was forecast: the factor 32 covers md-imex-5-2, whose ũ is closest
/// to u^{n+1} (estimate 0.0173), with 29; for all others the largest is 10. And forecasts are no false
/// alarms: where the forecast exceeds the tolerance, the error exceeds a thousandth of it (the bounds of the
/// forecast are far from sharp where steps begin to resolve the relaxation).
void check_all_tolerances(const std::string& name, double epsilon) {
  const apsis::method& m = apsis::find_method(name);
  long before = 0;
  for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
    const auto now = run_to(m, epsilon, tolerance);
    const auto trace = ::testing::Message()
                       << name << ", epsilon " << epsilon << ", tolerance " << tolerance << ": " << now.steps
                       << " steps, error " << now.error << ", forecast " << now.forecast;
    if (before > 0) {
      EXPECT_LE(now.steps, 30 * before) << trace;
    }
    if (now.forecast <= tolerance) {
      EXPECT_LE(now.error, 32 * tolerance) << trace;
    } else {
      EXPECT_GE(now.error, 0.001 * tolerance) << trace;
      EXPECT_LE(now.error, 25 * now.forecast) << trace;
    }
    before = now.steps;
  }
}

/// The same for the number of steps from data near equilibrium, without a layer.
void check_steps_near_equilibrium(const std::string& name, double epsilon) {
  const apsis::method& m = apsis::find_method(name);
  long before = 0;
  for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
    auto problem = ode_model::as_relaxation<state>(epsilon);
    apsis::stepper march(m, problem, apsis::solutions::result_and_embedded);
    apsis::step_controller<double> control(tolerance, m.embedded->order);
    state u{2.0, std::sin(2.0)};
    const long steps = apsis::integrate_to_tolerance(march, u, 0.0, 1.0,
                                                     apsis::step_rule<double>::unlimited(), control, distance)
                           .steps;
    if (before > 0) {
      EXPECT_LE(steps, 30 * before) << name << ", epsilon " << epsilon << ", tolerance " << tolerance;
    }
    before = steps;
  }
}

std::vector<std::string> imex_methods_with_embedded_row() {
  return methods_where(
      [](const apsis::method& m) { return m.embedded.has_value() && m.kind == apsis::method_kind::imex; });
}

}  // namespace

TEST(tolerances_from_1e_3_to_1e_9, cost_at_most_30_per_decade_and_are_met_or_forecast) {
  for (const char* name : {"md-imex-3-2", "md-imex-6-3", "md-imex-8-3-mixed", "md-imex-14-4-accurate"})
    for (const double epsilon : {1.0, 1e-2, 1e-4, 1e-6, 1e-10}) {
      check_all_tolerances(name, epsilon);
      check_steps_near_equilibrium(name, epsilon);
    }
}

TEST(tolerances_from_1e_3_to_1e_9, cost_at_most_30_per_decade_and_are_met_or_forecast_for_all_methods_slow) {
  const auto names = imex_methods_with_embedded_row();
  ASSERT_GE(names.size(), 16u);
  for (const auto& name : names)
    for (double epsilon = 1.0; epsilon > 0.9e-10; epsilon /= std::sqrt(10.0)) {
      check_all_tolerances(name, epsilon);
      check_steps_near_equilibrium(name, epsilon);
    }
}

TEST(global_error, scales_with_the_tolerance_to_the_power_p_over_q_plus_1) {
  // In the limit and where ε is resolved; plateaus intervene in between. Slopes over three decades differ
  // from the asymptotic ones by up to 0.21 (md-imex-14-4-accurate, 1.13 for 4/3), whose steps are still long.
  for (const auto& name :
       {"md-imex-3-2", "md-imex-8-3-mixed", "md-imex-8-3-accurate", "md-imex-14-4-accurate"}) {
    const apsis::method& m = apsis::find_method(name);
    const double expected = double(m.claims.order) / (m.embedded->order + 1);
    for (const double epsilon : {1.0, 1e-10}) {
      const double slope = std::log10(run_to(m, epsilon, 1e-5).error / run_to(m, epsilon, 1e-8).error) / 3;
      EXPECT_NEAR(slope, expected, 0.25) << name << " " << epsilon;
    }
  }
}

}  // namespace tolerance_table_test
