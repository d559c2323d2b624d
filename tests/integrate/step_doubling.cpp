// Step control of methods without an embedded solution compares one step with two of half its length.
#include "support/catalogue.hpp"

#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/exact_collisions.hpp>
#include <apsis/integrate/newton_problem.hpp>
#include <apsis/integrate/relaxation_problem.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <integrate/ode_model.hpp>
#include <integrate/reference.hpp>

namespace step_doubling_test {
namespace {

using apsis::method_kind;
using apsis::solutions;
using apsis::step_controller;
using apsis::step_rule;
using state = std::vector<double>;

std::vector<std::string> methods_that_double() {
  return methods_where([](const apsis::method& m) { return !m.embedded.has_value(); });
}

const auto distance = [](const state& u, const state& v) {
  double largest = 0.0;
  for (std::size_t k = 0; k < u.size(); ++k) largest = std::max(largest, std::abs(u[k] - v[k]));
  return largest;
};

/// Calls use(problem, start, solution at t = 1) with the ODE model of the paper at ε = 1. Methods without
/// transport get u' = −10u².
template <class Use>
auto with_problem(const apsis::method& m, const Use& use) {
  if (m.kind == method_kind::implicit_only) {
    auto problem = apsis::make_newton_problem<state>(
        apsis::no_transport{}, [](const auto& u, auto& out) { out[0] = -10 * u[0] * u[0]; });
    return use(problem, state{0.1}, state{0.05});
  }
  const auto exact = reference::radau(1, 1);
  const state end{static_cast<double>(exact[0]), static_cast<double>(exact[1])};
  auto problem = ode_model::as_relaxation<state>(1.0);
  if (m.kind == method_kind::exact_collision) {
    apsis::exact_collisions wrapped(problem);
    return use(wrapped, state{2, 0}, end);
  }
  return use(problem, state{2, 0}, end);
}

class every_method_without_embedded_row : public ::testing::TestWithParam<std::string> {};

TEST_P(every_method_without_embedded_row, keeps_tolerances_over_six_decades) {
  const apsis::method& m = apsis::find_method(GetParam());
  with_problem(m, [&](auto& problem, const state& start, const state& end) {
    apsis::stepper march(m, problem, solutions::result_and_embedded);
    long steps_before = 0;
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
      if (m.claims.order == 1 && tolerance < 1e-8) break;  // 1e5 steps
      step_controller<double> control(tolerance, apsis::estimate_of(m).order);
      state u = start;
      const auto done = apsis::integrate_to_tolerance(march, u, 0.0, 1.0, step_rule<double>::unlimited(),
                                                      control, distance);
      const double error = distance(u, end), p = m.claims.order;
      // The error of a step has order p + 1. The error of the whole interval is tolerance^{p/(p+1)} times a
      // constant of at most 30. Rounding errors of many steps add 1e-13.
      EXPECT_LT(error, 30 * std::pow(tolerance, p / (p + 1)) + 1e-13) << tolerance;
      // A tolerance 100 times smaller needs 100^{1/(p+1)} times as many steps, within factors of 2. Short
      // runs may need fewer, because their first steps count.
      const auto steps = static_cast<double>(done.steps);
      if (steps_before > 20) {
        EXPECT_LT(steps / static_cast<double>(steps_before), 2 * std::pow(100.0, 1 / (p + 1))) << tolerance;
        EXPECT_GT(steps / static_cast<double>(steps_before), 0.5 * std::pow(100.0, 1 / (p + 1))) << tolerance;
      }
      steps_before = done.steps;
    }
  });
}

TEST_P(every_method_without_embedded_row, continues_with_two_half_steps_bitwise) {
  const apsis::method& m = apsis::find_method(GetParam());
  with_problem(m, [&](auto& problem, const state& start, const state&) {
    apsis::stepper march(m, problem, solutions::result_and_embedded), alone(m, problem);
    state u = start, v = start;
    for (const double dt : {1e-2, 3e-2, 1e-2}) {
      state w = v;
      alone.step(0.0, dt, w);
      alone.step(0.0, dt / 2, v);
      alone.step(dt / 2, dt / 2, v);
      const state before = u;
      const auto tried = march.attempt(0.0, dt, u);
      EXPECT_EQ(u, before);
      EXPECT_EQ(tried.result, v);
      EXPECT_EQ(tried.embedded, w);
      march.accept(u);
      EXPECT_EQ(u, v);
    }
  });
}

TEST_P(every_method_without_embedded_row, estimates_a_term_of_order_p_plus_1) {
  const apsis::method& m = apsis::find_method(GetParam());
  with_problem(m, [&](auto& problem, const state& start, const state&) {
    apsis::stepper march(m, problem, solutions::result_and_embedded);
    const auto estimate = [&](double dt) {
      state u = start;
      const auto tried = march.attempt(0.0, dt, u);
      return distance(tried.result, tried.embedded);
    };
    // The step is long enough that the difference stays above rounding for order 8.
    const double dt = m.claims.order > 5 ? 0.25 : 0.02;
    EXPECT_NEAR(std::log2(estimate(dt) / estimate(dt / 2)), m.claims.order + 1,
                m.claims.order > 5 ? 1.0 : 0.35);
  });
}

INSTANTIATE_TEST_SUITE_P(step_doubling, every_method_without_embedded_row,
                         ::testing::ValuesIn(methods_that_double()), [](const auto& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(step_doubling, rejects_steps_that_an_explicit_method_cannot_take) {
  // λ = −1000. In steps beyond 2.8/1000 the two solutions differ by more than the tolerance.
  auto problem = apsis::make_newton_problem<state>(
      apsis::no_transport{}, [](const auto& u, auto& out) { out[0] = -1000 * (u[0] - 1); });
  const apsis::method& m = apsis::find_method("kutta-4");
  apsis::stepper march(m, problem, solutions::result_and_embedded);
  step_controller<double> control(1e-6, apsis::estimate_of(m).order);
  state u{0};
  const auto done =
      apsis::integrate_to_tolerance(march, u, 0.0, 1.0, step_rule<double>::unlimited(), control, distance);
  EXPECT_NEAR(u[0], 1, 1e-6);
  EXPECT_GT(done.steps, 150);  // stability: about 1/(2 · 2.8e-3), two half steps in each
  EXPECT_LT(done.steps, 1000);
  EXPECT_GT(control.rejected(), 0);
}

}  // namespace
}  // namespace step_doubling_test
