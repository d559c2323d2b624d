// Runs to tolerances with epsilon from 1 to 1e-10: their errors, and their steps compared with the
// best equal steps.
#include "support/catalogue.hpp"

#include <apsis/integrate/tolerance_forecast.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
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
  double error,  ///< relative error at t = 1
      forecast;  ///< forecast of the error of the O(ε) terms
};

/// Runs the ODE model of the paper from data out of equilibrium.
outcome run_to(const apsis::method& m, double epsilon, double tolerance) {
  static std::map<double, reference::pair> exact;
  if (!exact.contains(epsilon)) exact[epsilon] = reference::radau(epsilon, 1);
  auto problem = ode_model::as_relaxation<state>(epsilon);
  apsis::stepper march(m, problem, apsis::solutions::result_and_embedded);
  apsis::step_controller<double> control(tolerance, m.embedded->order);
  auto u = ode_model::initial_state<state>();
  const auto bounds = apsis::compute_plateau_bounds(apsis::to_butcher(m.coefficients<double>()));
  const auto expected =
      apsis::forecast_tolerance(march, 0.0, u, 1.0, 1.0, control.target(), bounds, distance);
  const auto done = apsis::integrate_to_tolerance(march, u, 0.0, 1.0, apsis::step_rule<double>::unlimited(),
                                                  control, distance);
  const auto& solution = exact[epsilon];
  return {done.steps + control.rejected(),
          distance(u, {static_cast<double>(solution[0]), static_cast<double>(solution[1])}), expected.error};
}

/// Returns pairs of a number of equal steps and an error, with a graded start or without. The error is the
/// largest of all numbers of steps within a quarter of this number, so that zero crossings of the error do
/// not count.
std::vector<std::pair<long, double>> fixed_steps(const apsis::method& m, double epsilon, bool graded,
                                                 long most) {
  const auto exact = reference::radau(epsilon, 1);
  const state solution{static_cast<double>(exact[0]), static_cast<double>(exact[1])};
  std::vector<std::pair<long, double>> runs, largest;
  for (double n = 1; n <= static_cast<double>(most); n = std::max(n + 1, std::floor(1.1 * n))) {
    auto problem = ode_model::as_relaxation<state>(epsilon);
    apsis::stepper march(m, problem);
    auto u = ode_model::initial_state<state>();
    const auto rule = apsis::step_rule<double>::fixed(1 / n);
    const auto done = apsis::integrate(march, u, 0.0, 1.0,
                                       rule.with(graded ? apsis::startup::graded : apsis::startup::none));
    runs.emplace_back(done.steps, distance(u, solution));
  }
  for (const auto& [steps, own] : runs) {
    double error = own;
    for (const auto& [others, other] : runs)
      if (4 * others <= 5 * steps + 4 && 5 * others >= 4 * steps - 5) error = std::max(error, other);
    largest.emplace_back(steps, error);
  }
  return largest;
}

/// Requires an error within a factor of 30 of the tolerance. Requires at most 3 times the steps of the best
/// equal steps with that error, up to `most`. The factor 2 is wanted; the largest measured is 2.9
/// (docs/methods.md shows where). Runs of three steps cannot be coarser, and may be more accurate.
void check_against_fixed_steps(const std::string& name, double epsilon, long most) {
  const apsis::method& m = apsis::find_method(name);
  auto fixed = fixed_steps(m, epsilon, false, most);
  const auto graded = fixed_steps(m, epsilon, true, most);
  fixed.insert(fixed.end(), graded.begin(), graded.end());
  for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    const auto now = run_to(m, epsilon, tolerance);
    const auto trace = ::testing::Message() << name << ", epsilon " << epsilon << ", tolerance " << tolerance
                                            << ": " << now.steps << " steps, error " << now.error;
    EXPECT_LE(now.error, 30 * tolerance) << trace;
    // The error of one number of steps may be near a zero, so neighbouring numbers of equal steps count too.
    double typical = now.error;
    for (const auto& [steps, error] : fixed)
      if (5 * steps >= 4 * now.steps && 4 * steps <= 5 * now.steps) typical = std::max(typical, error);
    if (now.steps > 3) {
      EXPECT_GE(typical, tolerance / 30) << trace;
    }
    long best = most;
    for (const auto& [steps, error] : fixed)
      if (error <= now.error) best = std::min(best, steps);
    if (best < most) {
      EXPECT_LE(now.steps, 3 * best) << trace << ", best " << best;
    }
  }
}

/// Requires errors within a factor of 30 of the tolerance, and of 100 for one method.
/// docs/methods.md#tolerances-and-equal-steps has three exceptions. This is the one at tolerances down to
/// 1e-7. At tolerances below the forecast of the terms of size ε, steps resolve ε/C.
void check_all_tolerances(const std::string& name, double epsilon) {
  const apsis::method& m = apsis::find_method(name);
  for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    const auto now = run_to(m, epsilon, tolerance);
    EXPECT_LE(now.error, (name == "md-imex-9-3-narrow" ? 100 : 30) * tolerance)
        << name << ", epsilon " << epsilon << ", tolerance " << tolerance << ": " << now.steps
        << " steps, error " << now.error << ", forecast " << now.forecast;
  }
}

/// Bounds the number of steps from data near equilibrium, without a layer.
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

TEST(tolerances, are_met_within_30_with_at_most_3_times_the_best_equal_steps) {
  for (const char* name : {"md-imex-3-2", "md-imex-8-3-mixed", "md-imex-8-3-accurate"})
    for (const double epsilon : {1.0, 1e-10}) check_against_fixed_steps(name, epsilon, 3000);
}

TEST(SLOW_tolerances, are_met_within_30_with_at_most_3_times_the_best_equal_steps_for_all_epsilon) {
  for (const char* name : {"md-imex-3-2", "md-imex-6-2-mixed", "md-imex-8-3-mixed", "md-imex-8-3-accurate"})
    for (const double epsilon : {1.0, 1e-2, 1e-4, 1e-6, 1e-10})
      check_against_fixed_steps(name, epsilon, 20000);
}

TEST(SLOW_tolerances, are_met_within_30_by_all_methods_but_one) {
  const auto names = imex_methods_with_embedded_row();
  ASSERT_GE(names.size(), 16u);
  for (const auto& name : names)
    for (const double epsilon : {1.0, 1e-2, 1e-4, 1e-6, 1e-10}) check_all_tolerances(name, epsilon);
}

TEST(steps_near_equilibrium, grow_by_at_most_30_per_decade_of_the_tolerance_in_the_limit) {
  for (const char* name : {"md-imex-3-2", "md-imex-6-3", "md-imex-8-3-mixed", "md-imex-14-4-accurate"})
    for (const double epsilon : {1.0, 1e-10}) check_steps_near_equilibrium(name, epsilon);
}

TEST(global_error, scales_with_the_tolerance_to_the_power_p_over_q_plus_1) {
  // The slopes hold in the limit and where ε is resolved, but not on the plateaus in between. Over three
  // decades they differ from the asymptotic ones by up to 0.2, because steps of fourth order are still long.
  for (const auto& name :
       {"md-imex-3-2", "md-imex-8-3-mixed", "md-imex-8-3-accurate", "md-imex-14-4-accurate"}) {
    const apsis::method& m = apsis::find_method(name);
    const double expected = double(m.claims.order) / (m.embedded->order + 1);
    for (const double epsilon : {1.0, 1e-10}) {
      const double slope = std::log10(run_to(m, epsilon, 1e-6).error / run_to(m, epsilon, 1e-9).error) / 3;
      EXPECT_NEAR(slope, expected, 0.25) << name << " " << epsilon;
    }
  }
}

}  // namespace tolerance_table_test
