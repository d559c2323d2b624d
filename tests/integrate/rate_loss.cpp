// Estimates of the terms of size ε that a method loses, against true errors of runs.
#include <apsis/integrate/rate_loss.hpp>

#include "support/catalogue.hpp"

#include <apsis/integrate/integrate.hpp>
#include <apsis/integrate/relaxation_problem.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <integrate/ode_model.hpp>

namespace rate_loss_test {

namespace {

using state = std::vector<double>;

const auto distance = [](const state& u, const state& v) {
  return std::hypot(u[0] - v[0], u[1] - v[1]) / std::hypot(u[0], u[1]);
};

/// The absolute difference, as in Python.
const auto largest_difference = [](const state& u, const state& v) {
  return std::max(std::abs(u[0] - v[0]), std::abs(u[1] - v[1]));
};

struct outcome {
  double estimate,  ///< estimate of the relative error at t = 1 in the terms of size ε
      error;        ///< relative error at t = 1
};

state start_of(bool near_equilibrium) {
  return near_equilibrium ? state{2.0, std::sin(2.0)} : ode_model::initial_state<state>();
}

/// Returns the solution at t = 1 by a method of order 8 without plateau. Its steps resolve the layer.
const state& exact_solution(double epsilon, bool near_equilibrium) {
  static std::map<std::pair<double, bool>, state> known;
  const auto [found, is_new] = known.try_emplace({epsilon, near_equilibrium}, start_of(near_equilibrium));
  if (!is_new) return found->second;
  auto problem = ode_model::as_relaxation<state>(epsilon);
  apsis::stepper march(apsis::find_method("extrapolated-euler-8"), problem);
  apsis::integrate(march, found->second, 0.0, 1.0,
                   apsis::step_rule<double>::fixed(1.0 / 2048.0).with(apsis::startup::graded));
  return found->second;
}

/// Runs the ODE model of the paper, from equilibrium or not, and estimates the loss at eight times.
outcome run(const apsis::method& m, double epsilon, double dt, bool near_equilibrium) {
  auto problem = ode_model::as_relaxation<state>(epsilon);
  apsis::stepper march(m, problem);
  state u = start_of(near_equilibrium);
  const auto response = apsis::compute_rate_response(m);
  double done = 0.0, result = 0.0;
  for (int k = 0; k < 8; ++k) {
    const auto loss =
        apsis::compute_rate_loss(problem, k / 8.0, u, dt, *response, distance, k == 0 && !near_equilibrium);
    done += loss->rate / 8.0 + loss->layer;
    result = loss->result;
    apsis::integrate(march, u, k / 8.0, (k + 1) / 8.0, apsis::step_rule<double>::fixed(dt));
  }
  return {done + result, distance(exact_solution(epsilon, near_equilibrium), u)};
}

std::vector<std::string> imex_methods() {
  return methods_where([](const apsis::method& m) { return m.kind == apsis::method_kind::imex; });
}

}  // namespace

TEST(rate_loss, of_methods_with_a_plateau_is_their_error) {
  // With Δt = 1/256 the errors Δt^p are small, and the terms of size ε dominate. The estimate adds norms, but
  // errors in the layer and in the flux may cancel. Data out of equilibrium therefore have a larger factor.
  for (const char* name :
       {"md-imex-3-2", "md-imex-6-3", "hsz-a-3-2", "md-imex-16-4-efficient", "md-imex-14-4-accurate"})
    for (const double epsilon : {1e-3, 3e-4, 1e-4})
      for (const bool near : {true, false}) {
        const auto found = run(apsis::find_method(name), epsilon, 1.0 / 256.0, near);
        EXPECT_LT(found.estimate, (near ? 6.0 : 25.0) * found.error) << name << " " << epsilon << " " << near;
        EXPECT_GT(found.estimate, found.error / 3.0) << name << " " << epsilon << " " << near;
      }
}

TEST(rate_loss, never_cries_wolf_for_any_method_and_ratio) {
  // Where the estimate would warn, the error is at least a tenth of it. It is at least a thirtieth where
  // errors in the layer and in the flux may cancel.
  int warned = 0, quiet = 0;
  for (const auto& name : imex_methods())
    for (const double epsilon : {1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-9})
      for (const double dt : {1.0 / 8.0, 1.0 / 64.0})
        for (const bool near : {true, false}) {
          const auto found = run(apsis::find_method(name), epsilon, dt, near);
          if (!(found.estimate > 1e-3)) {
            ++quiet;
            continue;
          }
          ++warned;
          EXPECT_GT(found.error, (near ? 0.1 : 0.03) * found.estimate)
              << name << ", epsilon " << epsilon << ", dt " << dt << ", near " << near;
        }
  EXPECT_GT(warned, 30);
  EXPECT_GT(quiet, 300);
}

TEST(rate_loss, of_methods_with_the_right_terms_is_small_at_every_ratio) {
  for (const char* name :
       {"md-imex-8-3-mixed", "md-imex-10-3-mixed", "md-imex-6-2-mixed", "extrapolated-euler-8"})
    for (double epsilon = 1.0; epsilon > 1e-9; epsilon /= 4.0)
      EXPECT_LT(run(apsis::find_method(name), epsilon, 1.0 / 64.0, true).estimate, 1e-3)
          << name << " " << epsilon;
}

TEST(rate_loss, of_a_deviation_that_stiff_transport_sustains_is_the_error) {
  // y' = −100 y + (100 atan t + 1/(1 + t²)). The first term is a collision, so T/C is as large as y.
  auto problem = apsis::make_relaxation_problem<state>(
      [](double, const state& u, state& out) {
        out = {1.0, 100.0 * std::atan(u[0]) + 1.0 / (1.0 + u[0] * u[0])};
      },
      [](const state& u) { return u[0]; }, [](double w, state& out) { out = {w, 0.0}; },
      [](double) { return 1.0; }, 0.01);
  const auto estimate = [&](const char* name) {
    const state u{5.0, std::atan(5.0)};
    return apsis::compute_rate_loss(problem, 5.0, u, 0.1, *apsis::compute_rate_response(name),
                                    largest_difference, false);
  };
  const auto unfit = estimate("md-imex-6-3"), fit = estimate("extrapolated-euler-8");
  apsis::stepper march(apsis::find_method("md-imex-6-3"), problem);
  state u{0.0, 0.0};
  apsis::integrate(march, u, 0.0, 10.0, apsis::step_rule<double>::fixed(0.1));
  const double error = std::abs(u[1] - std::atan(10.0)) / std::atan(10.0);
  EXPECT_GT(error, 0.5);
  EXPECT_NEAR(unfit->result / unfit->deviation, error, 0.15 * error);
  EXPECT_TRUE(apsis::judge_loss(*unfit, 0.0, 5.0, {}).large);
  EXPECT_LT(fit->result, 0.05 * unfit->result);
  // At y(0) = 0 the state does not show the size of the solution. The deviation that follows does.
  const state zero{0.0, 0.0};
  const auto start = apsis::compute_rate_loss(
      problem, 0.0, zero, 0.1, *apsis::compute_rate_response("md-imex-6-3"), largest_difference, false);
  EXPECT_TRUE(apsis::judge_loss(*start, 0.0, 10.0, {}).large);
}

TEST(rate_loss, without_transport_or_deviation_is_nothing) {
  auto problem = apsis::make_relaxation_problem<state>(
      [](double, const state&, state& out) { out = {0.0, 0.0}; }, [](const state& u) { return u[0]; },
      [](double w, state& out) { out = {w, w}; }, [](double) { return 1.0; }, 1e-4);
  const state u{1.0, 1.0};
  const auto loss = apsis::compute_rate_loss(problem, 0.0, u, 0.1,
                                             *apsis::compute_rate_response("md-imex-6-3"), distance, true);
  EXPECT_LT(loss->rate + loss->result + loss->layer, 1e-12);
  EXPECT_FALSE(apsis::judge_loss(*loss, 0.0, 1e3, {}).large);
}

TEST(rate_loss, is_unknown_where_a_solve_fails) {
  auto problem = apsis::make_relaxation_problem<state>(
      [](double, const state&, state& out) { out = {0.0, 0.0}; }, [](const state& u) { return u[0]; },
      [](double w, state& out) { out = {w, std::sqrt(-w)}; }, [](double) { return 1.0; }, 1e-4);
  const state u{1.0, 1.0};
  EXPECT_FALSE(apsis::compute_rate_loss(problem, 0.0, u, 0.1, *apsis::compute_rate_response("md-imex-6-3"),
                                        distance, true));
}

TEST(verdict, is_by_the_error_or_by_the_part_of_all_changes) {
  const apsis::rate_loss<double> slow{.rate = 1e-4, .diffusion = 1e-4, .change = 1e-4},
      fast{.rate = 1e-4, .diffusion = 1e-4, .change = 1e-2}, none{},
      fit{.rate = 1e-4, .diffusion = 1e-2, .change = 1e-4}, wrong_stress{.result = 2e-3, .deviation = 1e-2};
  EXPECT_TRUE(apsis::judge_loss(slow, 0.0, 1.0, {}).large);    // 1e-4 of the state, but all of the change
  EXPECT_FALSE(apsis::judge_loss(slow, 0.0, 0.01, {}).large);  // 1e-6 of the state
  EXPECT_FALSE(apsis::judge_loss(fast, 0.0, 1.0, {}).large);
  EXPECT_TRUE(apsis::judge_loss(fast, 0.0, 20.0, {}).large);
  EXPECT_FALSE(apsis::judge_loss(fast, 0.0, 20.0, 1e-3).large);  // 30 tolerances
  EXPECT_FALSE(apsis::judge_loss(none, 0.0, 1e9, {}).large);
  EXPECT_FALSE(apsis::judge_loss(fit, 0.0, 1e9, {}).large);  // viscosity is right to 1 %
  EXPECT_TRUE(apsis::judge_loss(wrong_stress, 0.0, 1.0, {}).large);
  EXPECT_TRUE(apsis::judge_loss(none, 2e-3, 1.0, {}).large);  // the loss of earlier steps
  // The moments have not yet changed by their own size.
  EXPECT_NEAR(apsis::judge_loss(fast, 0.0, 1e9, {}).expected, 1e-2, 1e-12);
  EXPECT_EQ(apsis::judge_loss(slow, 0.0, 1e9, {}).expected, 1.0);
  EXPECT_THAT(apsis::describe_loss("m", {.rate = 1.63, .diffusion = 1.0}, 0.0, 0.1, 2.0, 0.01),
              testing::HasSubstr("viscosity, are wrong by 163 %"));
}

}  // namespace rate_loss_test
