// Embedded solutions through the stepper: cost, order, and step-size control.
#include "support/catalogue.hpp"

#include <apsis/integrate/error_control.hpp>
#include <apsis/method/certificate.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <integrate/ode_model.hpp>
#include <integrate/random_form.hpp>
#include <integrate/reference.hpp>
#include <support/property.hpp>

namespace embedded_test {

namespace {

using apsis::method_kind;
using apsis::solutions;
using apsis::step_controller;
using apsis::step_rule;
using real = long double;
using state = std::vector<real>;

std::vector<std::string> methods_with_embedded_row() {
  return methods_where([](const apsis::method& m) { return m.embedded.has_value(); });
}

const auto distance = [](const auto& u, const auto& v) {
  auto sum = std::abs(u[0] - v[0]);
  for (std::size_t k = 1; k < u.size(); ++k) sum += std::abs(u[k] - v[k]);
  return sum;
};

/// Calls use(march, u) with the ODE model of the paper and u2(0) = `rest`. Methods without transport get u' =
/// −10u² (as in method_orders.cpp).
template <class Use>
auto with_problem(const std::string& name, real epsilon, real rest, const Use& use) {
  const apsis::method& m = apsis::find_method(name);
  if (m.kind == method_kind::implicit_only) {
    auto problem = apsis::make_newton_problem<state>(
        apsis::no_transport{}, [](const auto& u, auto& out) { out[0] = -10 * u[0] * u[0]; });
    apsis::stepper march(m, problem, solutions::result_and_embedded);
    return use(march, state{real(1) / 10});
  }
  auto problem = ode_model::as_relaxation<state>(epsilon);
  apsis::stepper march(m, problem, solutions::result_and_embedded);
  return use(march, state{2, rest});
}

/// In equilibrium Q vanishes. All elementary differentials of the ODE model that a method of order 1 may not
/// resolve then vanish too.
const real consistent = std::sin(real(2)), inconsistent = 0;

/// Returns ‖u^{n+1} − ũ‖ after one step.
double estimate(const std::string& name, real epsilon, real rest, real dt) {
  return with_problem(name, epsilon, rest, [dt](auto& march, state u) {
    const auto tried = march.attempt(0, dt, u);
    return static_cast<double>(distance(tried.result, tried.embedded));
  });
}

/// Returns the error at t = 1 if the steps continue from ũ instead of u^{n+1}.
double error_carried_on(const std::string& name, long steps) {
  return with_problem(name, 1, inconsistent, [steps](auto& march, state u) {
    const real dt = real(1) / static_cast<real>(steps);
    for (long n = 0; n < steps; ++n) u = state(march.attempt(static_cast<real>(n) * dt, dt, u).embedded);
    if (u.size() == 1) return static_cast<double>(std::abs(u[0] - real(1) / 20));
    const auto exact = reference::radau(1, 1);
    return static_cast<double>(distance(u, state{exact[0], exact[1]}));
  });
}

class every_embedded_row : public ::testing::TestWithParam<std::string> {};

/// If the leading error term is small, the next one is a tenth of it, unless steps are very short. This
/// changes the slope by 0.15, and by 0.16 for md-imex-9-3-large-r.
constexpr double tolerance = 0.17;

TEST_P(every_embedded_row, has_its_certified_order) {
  const int q = apsis::find_certificate(GetParam()).embedded->order;
  // With these steps the errors stay above that of the reference, 3e-16.
  const long steps = q > 4 ? 64 : q > 3 ? 256 : apsis::find_method(GetParam()).is_tableau() ? 1024 : 4096;
  EXPECT_NEAR(std::log2(error_carried_on(GetParam(), steps) / error_carried_on(GetParam(), 2 * steps)), q,
              tolerance);
}

TEST_P(every_embedded_row, estimates_a_term_of_order_q_plus_1) {
  const int q = apsis::find_certificate(GetParam()).embedded->order;
  // The expression is not real(1)/(q > 3 ? 128 : 1024). clang 19.1 would subtract exponents for it, in the
  // wrong bits of a long double.
  const real dt = q > 3 ? real(1) / 128 : real(1) / 1024;
  const auto slope = [&](real epsilon, real rest) {
    return std::log2(estimate(GetParam(), epsilon, rest, dt) / estimate(GetParam(), epsilon, rest, dt / 2));
  };
  EXPECT_NEAR(slope(1, inconsistent), q + 1, tolerance);
  // In the limit ũ lies on the equilibrium manifold, like u^{n+1}, and only the trees of T remain. Data out
  // of equilibrium leave terms of size ε/Δt = 1e-19, far below the smallest estimate, 1e-14. The ũ of a
  // tableau is not a stage and is excluded.
  const apsis::method& m = apsis::find_method(GetParam());
  if (m.kind == method_kind::imex && !m.is_tableau()) {
    EXPECT_NEAR(slope(1e-22L, consistent), q + 1, tolerance);
    EXPECT_NEAR(slope(1e-22L, inconsistent), q + 1, tolerance);
  }
}

TEST_P(every_embedded_row, does_not_change_the_result_bitwise) {
  with_problem(GetParam(), 1e-2L, inconsistent, [&](auto& march, state u) {
    auto& problem = march.problem();
    apsis::stepper alone(apsis::find_method(GetParam()), problem);
    state v = u;
    for (int n = 0; n < 20; ++n) {
      const real stable = apsis::find_method(GetParam()).kind == method_kind::explicit_only ? 0.0005L : 0.01L;
      const real dt = stable * static_cast<real>(1 + n % 3);
      alone.step(real(0), dt, v);
      const auto tried = march.attempt(real(0), dt, u);
      EXPECT_EQ(tried.result, v);
      EXPECT_NE(tried.embedded, v);
      EXPECT_NE(u, v);  // u is still u^n until the step is accepted
      march.accept(u);
      EXPECT_EQ(u, v);
    }
    return 0;
  });
}

TEST_P(every_embedded_row, has_the_cost_of_its_certificate) {
  const apsis::method& m = apsis::find_method(GetParam());
  const auto& c = apsis::find_certificate(GetParam());
  const apsis::schedule alone(m.coefficients<double>()),
      both(m.with_embedded_row().coefficients<double>(), true);
  EXPECT_EQ(both.transport_evaluations(), c.explicit_evaluations + c.embedded->explicit_evaluations);
  EXPECT_EQ(both.implicit_solves(), c.implicit_solves + c.embedded->implicit_solves);
  EXPECT_GE(both.buffers(), alone.buffers());
  EXPECT_LE(both.buffers(), alone.buffers() + 2);  // ũ, and a stage that it still needs
}

INSTANTIATE_TEST_SUITE_P(catalogue, every_embedded_row, ::testing::ValuesIn(methods_with_embedded_row()),
                         test_name);

/// u' = λ_T u + λ_Q u.
class linear {
 public:
  using state = std::vector<double>;
  using real = double;
  double transport = 0.0, collision = 0.0;
  void add_transport(double, const state& u, std::span<const apsis::target<state, double>> targets) const {
    for (const auto& to : targets) (*to.acc)[0] = to.combine((*to.acc)[0], u[0], transport * u[0]);
  }
  void solve_collision(double, double a, double b, state& u) const {
    u[0] /= 1.0 - a * collision - b * collision * collision;
  }
  void add_collision(double, const state& u, std::span<const apsis::target<state, double>> targets) const {
    for (const auto& to : targets) (*to.acc)[0] = to.combine((*to.acc)[0], u[0], collision * u[0]);
  }
  double forward_euler_step(double, const state&) const { return 1.0; }
};

apsis::shu_osher_form<double> without_last_row(const apsis::shu_osher_form<double>& m) {
  const std::size_t s = m.stages() - 1;
  apsis::shu_osher_form<double> rest;
  rest.P = rest.W = rest.D = apsis::matrix<double>(s, s);
  rest.r = m.r;
  rest.ddot.assign(m.ddot.begin(), m.ddot.end() - 1);
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      rest.P(i, j) = m.P(i, j);
      rest.W(i, j) = m.W(i, j);
      rest.D(i, j) = m.D(i, j);
    }
  return rest;
}

TEST(embedded_schedule, of_any_zero_pattern_computes_both_solutions) {
  check_property("random forms", [] {
    const auto form = random_input::form(2);
    linear p;
    p.transport = *rc::gen::inRange(-1000, 1000) * 1e-3;
    p.collision = -*rc::gen::inRange(1, 1000) * 1e-3;
    const auto kind = method_kind::imex;
    std::vector<double> u = {1.0}, result = u, last = u;
    apsis::stepper<linear> both(form, kind, p, "both", solutions::result_and_embedded);
    apsis::stepper<linear> alone(without_last_row(form), kind, p), whole(form, kind, p);
    alone.step(0.0, 1.0, result);
    whole.step(0.0, 1.0, last);
    const auto tried = both.attempt(0.0, 1.0, u);
    RC_ASSERT(tried.result == result);  // bitwise
    RC_ASSERT(std::abs(tried.embedded[0] - last[0]) <= 1e-11 * (1.0 + std::abs(last[0])));
    RC_ASSERT(u[0] == 1.0);
  });
}

struct controlled {
  double error;
  long steps, rejected;
};

/// Solves the ODE model from data out of equilibrium. The layer of width ε requires short initial steps.
controlled solve_to(const std::string& name, real tol, real epsilon, real longest) {
  const apsis::method& m = apsis::find_method(name);
  const auto exact = reference::radau(epsilon, 1);
  auto problem = ode_model::as_relaxation<state>(epsilon);
  apsis::stepper march(m, problem, solutions::result_and_embedded);
  step_controller<real> control(tol, m.embedded->order);
  auto u = ode_model::initial_state<state>();
  real last = 0;
  const auto done =
      apsis::integrate_to_tolerance(march, u, real(0), real(1), step_rule<real>::fixed(longest), control,
                                    distance, [&](long, real t, real dt, const state&) {
                                      EXPECT_LE(dt, longest);
                                      EXPECT_TRUE(t > last || t == 0);
                                      last = t;
                                    });
  EXPECT_EQ(done.t, 1);
  return {static_cast<double>(std::abs(u[0] - exact[0]) + std::abs(u[1] - exact[1])), done.steps,
          control.rejected()};
}

TEST(step_control, reduces_the_error_with_the_tolerance) {
  const auto coarse = solve_to("md-imex-8-3-accurate", 1e-5L, 1e-2L, 1),
             fine = solve_to("md-imex-8-3-accurate", 1e-8L, 1e-2L, 1);
  // A method has order p, its estimate order q + 1, and errors per step are below tol. About tol^{−1/(q+1)}
  // steps with errors tol^{(p+1)/(q+1)} give tol^{p/(q+1)} at the end. This is proportional to the
  // tolerance for p = 3 and q = 2. The bound is ten times larger, because the resolution of ε/C ends
  // between the two tolerances.
  EXPECT_LT(fine.error, 1e-2 * coarse.error);
  EXPECT_LT(fine.error, 1e-6);
  // The number of steps grows by the factor 1000^{1/(q+1)} = 10.
  EXPECT_GT(fine.steps, 4 * coarse.steps);
  EXPECT_LT(fine.steps, 25 * coarse.steps);
  EXPECT_LT(coarse.rejected, coarse.steps / 4);  // the first step is not far too long
  EXPECT_LT(fine.rejected, fine.steps / 4);
}

TEST(step_control, does_not_resolve_the_relaxation_beyond_the_tolerance) {
  // ε = 1e-4 is far above the tolerance. After the layer it does not matter for methods with or without
  // plateau. With the unweighted estimate ‖u^{n+1} − ũ‖, md-imex-3-2 would take 9400 steps here.
  const real tol = 3e-6L;
  for (const char* name : {"md-imex-8-3", "md-imex-3-2"}) {
    const long steps = solve_to(name, tol, 1e-4L, 1).steps;
    EXPECT_LT(steps, 6 * solve_to(name, tol, 1e-12L, 1).steps) << name << " " << steps;
  }
  EXPECT_LT(solve_to("md-imex-8-3", tol, 1e-4L, 1).error, 1e-4);
}

TEST(step_control, never_exceeds_the_limit_of_the_step_rule) {
  EXPECT_EQ(solve_to("md-imex-8-3", 1.0L, 1, real(1) / 8).steps, 8);
  EXPECT_EQ(solve_to("md-imex-8-3", 1.0L, 1, real(1) / 8).rejected, 0);
}

TEST(error_estimate, is_multiplied_by_the_weight_but_for_the_part_that_relaxes) {
  // u₂ relaxes to 0 within ε ≪ Δt, without changing u₁.
  auto problem = apsis::make_relaxation_problem<std::vector<double>>(
      apsis::no_transport{}, [](const auto& u) { return u[0]; }, [](double w, auto& out) { out = {w, 0.0}; },
      [](double) { return 1.0; }, 1e-9);
  const auto norm = [](const std::vector<double>& u, const std::vector<double>& v) {
    return std::hypot(u[0] - v[0], u[1] - v[1]);
  };
  const std::vector<double> start{1.0, 0.0}, result{2.0, 0.0}, along{2.01, 0.0}, off{2.0, 0.01};
  const auto of = [&](double weight, const std::vector<double>& other) {
    apsis::error_estimate<decltype(problem)> estimate(weight);
    return estimate(problem, 0.0, 1.0, start, {result, other}, norm);
  };
  for (const double weight : {1.0, 7.5}) {
    EXPECT_NEAR(of(weight, along), weight * 0.01, 1e-14);  // the rounding of 2.01
    // The expected value is W w/(1 + w) times 0.01 with w = 1/(10 W). The part of v after a relaxation, 1/(1
    // + z), is 1e-9.
    EXPECT_NEAR(of(weight, off), 0.01 * 0.1 / (1.0 + 0.1 / weight), 1e-9);
  }
}

TEST(step_control, rejects_nan_errors_and_invalid_tolerances) {
  step_controller<double> control(1e-3, 2);
  EXPECT_FALSE(control.accepts(1.0, std::nan("")));
  EXPECT_DOUBLE_EQ(control.proposed(), 0.2);
  EXPECT_FALSE(control.accepts(0.2, std::numeric_limits<double>::infinity()));
  EXPECT_DOUBLE_EQ(control.proposed(), 0.04);
  EXPECT_TRUE(control.accepts(0.04, 0.0));
  EXPECT_DOUBLE_EQ(control.proposed(), 0.04);  // no increase right after a rejection
  EXPECT_TRUE(control.accepts(0.04, 0.0));
  EXPECT_DOUBLE_EQ(control.proposed(), 0.08);  // twice the length at most
  EXPECT_EQ(control.rejected(), 2);
  for (const double wrong : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(step_controller<double>(wrong, 2), apsis::input_error);
}

TEST(step_control, settles_where_the_error_is_close_to_the_tolerance) {
  // With err = Δt³ the longest acceptable step is tol^{1/3}.
  step_controller<double> control(1e-6, 2);
  double dt = 1.0;
  for (int n = 0; n < 200; ++n) {
    control.accepts(dt, dt * dt * dt);
    dt = control.proposed();
  }
  EXPECT_NEAR(dt, 0.9e-2, 1e-12);
}

TEST(step_control, follows_the_trend_of_errors_that_grow) {
  // Each acceptable step is 15 % shorter than the one before. A step of 0.9 times the last length would be
  // too long again.
  step_controller<double> control(1e-6, 2);
  double longest = 1.0, dt = 0.9;
  for (int accepted = 0; accepted < 40;) {
    if (control.accepts(dt, 1e-6 * std::pow(dt / longest, 3))) {
      ++accepted;
      longest *= 0.85;
    }
    dt = control.proposed();
  }
  EXPECT_LE(control.rejected(), 1);  // without the trend, 20
}

TEST(step_control, throws_if_no_step_is_short_enough) {
  auto problem = ode_model::as_relaxation<state>(1);
  apsis::stepper march(apsis::find_method("md-imex-3-2"), problem, solutions::result_and_embedded);
  step_controller<real> control(1e-3L, 1);
  auto u = ode_model::initial_state<state>();
  const auto hopeless = [](const state&, const state&) { return real(1); };
  EXPECT_THROW(
      apsis::integrate_to_tolerance(march, u, real(1), real(2), step_rule<real>::fixed(1), control, hopeless),
      apsis::numerical_error);
  EXPECT_EQ(u, ode_model::initial_state<state>());
}

/// u' = −u, where every stage requires u ≥ 0. Steps beyond r violate this.
auto nonnegative_decay(bool possible) {
  apsis::relaxation_problem problem(
      [](double, const std::vector<double>& u, std::vector<double>& T) { T = {-u[0]}; },
      [](const std::vector<double>& u) { return u[0]; }, [](double w, std::vector<double>& E) { E = {w}; },
      [](double) { return 1.0; }, 1.0);
  problem.with_admissible([possible](const std::vector<double>& u) { return possible && u[0] >= 0; });
  return problem;
}

double no_distance(const std::vector<double>&, const std::vector<double>&) {
  return 0.0;
}

TEST(step_control, shortens_the_step_if_a_stage_fails) {
  auto problem = nonnegative_decay(true);
  apsis::stepper march(apsis::find_method("md-imex-8-3-mixed"), problem, solutions::result_and_embedded);
  std::vector<double> u{1.0};
  EXPECT_THROW(march.attempt(0.0, 8.0, u), apsis::numerical_error) << "the test requires a failing step";
  step_controller<double> control(1e-3, 1);
  const auto done =
      apsis::integrate_to_tolerance(march, u, 0.0, 8.0, step_rule<double>::fixed(8), control, no_distance);
  EXPECT_EQ(done.t, 8.0);
  EXPECT_GT(control.rejected(), 0);
  EXPECT_GE(u[0], 0.0);
}

TEST(step_control, reports_why_no_step_is_possible) {
  auto problem = nonnegative_decay(false);
  apsis::stepper march(apsis::find_method("md-imex-8-3-mixed"), problem, solutions::result_and_embedded);
  std::vector<double> u{1.0};
  step_controller<double> control(1e-3, 1);
  try {
    apsis::integrate_to_tolerance(march, u, 1.0, 2.0, step_rule<double>::fixed(1), control, no_distance);
    FAIL() << "a step was taken";
  } catch (const apsis::numerical_error& failure) {
    EXPECT_THAT(failure.problem(), testing::HasSubstr("admissible"));
    EXPECT_EQ(failure.site().step, 1);
  }
  EXPECT_EQ(u[0], 1.0);
}

}  // namespace

}  // namespace embedded_test
