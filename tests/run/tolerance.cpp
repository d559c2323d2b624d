// With time.tolerance the estimated error determines the steps of a production run.
#include "ode_runs.hpp"
#include "support/catalogue.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/integrate/stepper.hpp>
#include <apsis/run/setup.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tolerance_test {

namespace {

using testing::HasSubstr;

apsis::case_config ode(const std::string& method, const std::string& more) {
  return apsis::parse_case("[model]\nname = \"ode\"\nepsilon = 1e-2\n[time]\nmethod = \"" + method +
                               "\"\nend = 1.0\ndt = 0.5\n" + more,
                           "c.toml");
}

/// Returns the smallest value of ũ in three steps of r Δt_FE.
double smallest_of_embedded(const std::string& method, const std::string& epsilon,
                            const std::string& scheme) {
  const auto c = apsis::load_case(
      "paper/broadwell", {"time.method=" + method, "model.epsilon=" + epsilon,
                          "space.reconstruction=" + scheme, "space.limiter=positivity", "time.safety=1"});
  const apsis::run_setup setup(c);
  const auto problem = setup.make_problem();
  apsis::stepper march(setup.integrator().starter(), *problem, apsis::solutions::result_and_embedded);
  apsis::field u = setup.initial_state();
  double smallest = std::numeric_limits<double>::infinity(), t = 0.0;
  for (int n = 0; n < 3; ++n) {
    const double dt = setup.ssp_coefficient() * problem->forward_euler_step(t, u);
    const auto tried = march.attempt(t, dt, u);
    for (int cell = 0; cell < u.cells(); ++cell)
      for (int k = 0; k < u.components(); ++k) smallest = std::min(smallest, tried.embedded.row(cell)[k]);
    march.accept(u);
    t += dt;
  }
  return smallest;
}

}  // namespace

TEST(tolerance, bounds_the_error) {
  const double coarse = error_at_one(ode("md-imex-8-3-mixed", "tolerance = 1e-4\n"));
  const double fine = error_at_one(ode("md-imex-8-3-mixed", "tolerance = 1e-9\n"));
  // Below 1e-4 errors off equilibrium have less weight until steps resolve epsilon/C (docs/methods.md).
  EXPECT_LT(fine, 1e-2 * coarse);
  EXPECT_LT(fine, 1e-5);
  // Without a tolerance dt = 0.5 does not resolve the layer of width 0.002. With one it is only
  // the largest step.
  EXPECT_GT(error_at_one(ode("md-imex-8-3-mixed", "")), 1e3 * fine);
}

TEST(tolerance, counts_rejected_steps_and_respects_the_step_rule) {
  // Steps that begin to resolve ε are at first too long.
  const auto done =
      finished(apsis::load_case("paper/ode", {"time.method=md-imex-16-4-accurate", "time.dt=0.5",
                                              "time.tolerance=1e-8", "model.epsilon=1e-3"}));
  EXPECT_GE(done.rejected_steps, 1);
  EXPECT_LE(done.dt, 0.5);
  EXPECT_EQ(done.t, 1.0);
  const auto loose = finished(ode("md-imex-8-3", "tolerance = 1e6\n"));
  EXPECT_EQ(loose.rejected_steps, 0);
  EXPECT_EQ(loose.steps, 2);
}

TEST(tolerance, restarts_bit_for_bit) {
  const auto expect_same = [](const apsis::case_config& c, long steps) {
    apsis::simulation whole(c), first(c), second(c);
    for (long k = 0; k < steps; ++k) {
      whole.advance();
      first.advance();
    }
    second.restore(first.save());
    EXPECT_EQ(second.dt(), whole.dt());
    EXPECT_EQ(rest_of(whole), rest_of(second)) << steps;
  };
  for (const long steps : {0L, 1L, 2L, 7L}) expect_same(ode("md-imex-8-3", "tolerance = 1e-5\n"), steps);
  auto c = small("md-imex-3-2", "finite-difference");
  c.time.tolerance = 1e-4;
  c.time.end = 0.01;
  expect_same(c, 3);
  for (const long steps : {0L, 3L})
    expect_same(ode("md-imex-8-3", "tolerance = 1e-5\nstartup = \"graded\"\n"), steps);
}

TEST(tolerance, is_kept_by_explicit_additive_and_exponential_methods) {
  // The estimates use weights of the method, or compare one step with two halves.
  for (const char* name :
       {"kutta-4", "ssprk-10-4", "dop853", "ars-443", "ssp3-433", "ark-548", "bhr-553", "exponential-2"}) {
    const auto of = [&](const char* tolerance) {
      return ode(name, std::string("tolerance = ") + tolerance + "\n");
    };
    const double coarse = error_at_one(of("1e-4")), fine = error_at_one(of("1e-7"));
    EXPECT_LT(coarse, 1e-2) << name;  // 100 tolerances
    EXPECT_LT(fine, 1e-5) << name;
    // Steps of explicit methods end at the limit of stability. Their errors are far below the tolerance.
    EXPECT_LT(fine, std::max(coarse / 20, 1e-7)) << name;
  }
  const auto done = finished(apsis::load_case(
      "paper/ode", {"time.method=kutta-4", "time.dt=0.5", "time.tolerance=1e-6", "model.epsilon=1e-3"}));
  EXPECT_GE(done.rejected_steps, 1);  // 0.5 is far beyond the stable step
}

TEST(tolerance, restarts_bit_for_bit_with_doubled_steps) {
  for (const char* name : {"ars-443", "ark-436"}) {
    auto c = small(name, "finite-volume");
    c.time.tolerance = 1e-4;
    c.time.end = 0.01;
    apsis::simulation whole(c), first(c), second(c);
    for (int k = 0; k < 3; ++k) {
      whole.advance();
      first.advance();
    }
    second.restore(first.save());
    EXPECT_EQ(second.dt(), whole.dt()) << name;
    EXPECT_EQ(rest_of(whole), rest_of(second)) << name;
    for (const double defect : whole.last().conservation_defect) EXPECT_LT(defect, 1e-12) << name;
  }
}

TEST(tolerance, keeps_the_promises_of_the_step_rule) {
  auto c = small("md-imex-8-3", "finite-volume");
  c.time.cfl.reset();
  c.time.safety = 1.0;
  c.time.tolerance = 1e-3;
  apsis::simulation run(c);
  EXPECT_TRUE(run.promises().positivity);
  finish(run);  // throws where a promise is broken
  EXPECT_EQ(run.summary().negative_values, 0);
}

TEST(embedded_solution, is_positive_up_to_the_step_of_the_method_for_any_epsilon) {
  const auto names = methods_where([](const apsis::method& m) {
    return m.embedded && !m.is_tableau() && m.kind == apsis::method_kind::imex && m.stages() < 10;
  });
  for (const auto& method : names)
    for (const char* epsilon : {"0", "1e-12", "1e-3", "1", "1e12"})
      for (const char* scheme : {"upwind1", "weno5-z"})
        EXPECT_GE(smallest_of_embedded(method, epsilon, scheme), 0.0)
            << method << " " << epsilon << " " << scheme;
}

TEST(tolerance, with_a_graded_start_resolves_the_layer) {
  // The first step is the time in which D₀ changes u by tol^{1/2} = 0.01. Here ε/C = 1e-2/5 and
  // |D₀|/|u| = sin(2)/2.
  const std::string near =
      "[model]\nname = \"ode\"\nepsilon = 1e-2\ninitial = \"given\"\nu1 = 2.0\nu2 = 0.90930499\n"
      "[time]\nmethod = \"md-imex-3-2\"\nend = 1.0\ndt = 0.5\ntolerance = 1e-3\n";
  const auto first = [](const apsis::case_config& c) { return apsis::simulation(c).dt(); };
  EXPECT_NEAR(first(ode("md-imex-3-2", "tolerance = 1e-4\n")), 2e-3 * 0.01 * 2.0 / std::sin(2.0), 1e-9);
  // The layer changes the moments by 9e-4 |u|/2, so a larger tolerance does not resolve it.
  EXPECT_GT(first(ode("md-imex-3-2", "tolerance = 1e-3\n")), 0.02);
  // For data near equilibrium the first step follows the slow solution unless a graded start is requested.
  EXPECT_GT(first(apsis::parse_case(near, "c.toml")), 0.02);
  EXPECT_DOUBLE_EQ(first(apsis::parse_case(near + "startup = \"graded\"\n", "c.toml")), 5e-4);
  EXPECT_EQ(finished(apsis::parse_case(near + "startup = \"graded\"\n", "c.toml")).t, 1.0);
}

TEST(tolerance, below_the_plateau_of_a_method_is_warned_about_at_the_start) {
  const auto warning_of = [](const std::string& method, const std::string& tolerance) {
    testing::internal::CaptureStderr();
    const apsis::simulation run(ode(method, "tolerance = " + tolerance + "\n"));
    return testing::internal::GetCapturedStderr();
  };
  const std::string warning = warning_of("md-imex-6-3", "1e-5");
  EXPECT_THAT(warning, HasSubstr("time.tolerance = 1e-05 is below what method 'md-imex-6-3' keeps"));
  EXPECT_THAT(warning, HasSubstr("choose a method with the right terms, such as md-imex-8-3-mixed, "));
  EXPECT_EQ(warning_of("md-imex-8-3-mixed", "1e-3"), "");
}

TEST(dense_newton, of_more_than_200_unknowns_is_warned_about_once_before_the_run) {
  // On a lattice of n × n velocities there is a collision (0, 0) + (i, j) ↔ (i, 0) + (0, j) for each i, j ≥
  // 1. They are independent, so a stage has (n − 1)² unknowns.
  const auto warning_of = [](int n, const std::string& method) {
    std::string velocities, collisions;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        velocities += fmt::format("[{}, {}],", i, j);
        if (i > 0 && j > 0) collisions += fmt::format("[1, {}, {}, {}],", i * n + j + 1, i * n + 1, j + 1);
      }
    testing::internal::CaptureStderr();
    const apsis::simulation run(
        apsis::parse_case(fmt::format("[model]\nname = \"discrete-velocity\"\nvelocities = [{}]\ncollisions "
                                      "= [{}]\n[space]\ncells = 3\nreconstruction = \"upwind1\"\n"
                                      "domain = [0, 1]\n[time]\nmethod = \"{}\"\nend = 1e-3\ndt = 1e-3\n",
                                      velocities, collisions, method),
                          "c.toml"));
    return testing::internal::GetCapturedStderr();
  };
  const std::string warning = warning_of(16, "md-imex-3-2");
  EXPECT_THAT(
      warning,
      HasSubstr("a collision has 225 unknowns, and each Newton step of a stage takes about n^3 = 1e+07"));
  EXPECT_THAT(warning, HasSubstr("such as bgk"));
  EXPECT_EQ(warning.find("unknowns"), warning.rfind("unknowns"));
  EXPECT_EQ(warning_of(15, "md-imex-3-2").find("unknowns"), std::string::npos);  // 196
  EXPECT_EQ(warning_of(16, "ssprk-2-2").find("unknowns"), std::string::npos);    // explicit
}

TEST(explicit_method, for_a_stiff_collision_is_warned_about_with_the_number_of_steps) {
  const auto c = apsis::parse_case(
      "[model]\nname = \"ode\"\nepsilon = 1e-9\n[time]\nmethod = \"ssprk-3-3\"\nend = 1.0\ndt = 1e-3\n",
      "c.toml");
  testing::internal::CaptureStderr();
  const apsis::simulation run(c);
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              HasSubstr("stable in steps of about epsilon/C = 2e-10 only, about 5e+09 of them"));
}

namespace {

/// Returns a case with Knudsen numbers from 1e-5 to 1 and point values. Runs with different steps thus solve
/// the same system.
apsis::case_config mixed_bgk(const std::string& method, double tolerance) {
  auto c = small(method, "finite-difference");
  c.space.limiter = apsis::limiter_choice::none;  // depends on the length of the step
  c.time.cfl = 4.0;                               // only the tolerance limits the step
  c.time.end = 0.01;
  c.time.tolerance = tolerance;
  // These methods are asymptotic preserving for consistent data only, so runs warn about them.
  if (apsis::find_method(method).is_tableau()) c.time.startup = apsis::startup_choice::graded;
  return c;
}

std::vector<double> at_the_end(const apsis::case_config& c) {
  apsis::simulation run(c);
  finish(run);
  return run.state();
}

double relative(const std::vector<double>& u, const std::vector<double>& v) {
  double difference = 0.0, size = 0.0;
  for (std::size_t k = 0; k < u.size(); ++k) {
    difference += (u[k] - v[k]) * (u[k] - v[k]);
    size += v[k] * v[k];
  }
  return std::sqrt(difference / size);
}

/// Returns the state after steps of 2.5e-7, a fortieth of the smallest ε/C.
const std::vector<double>& converged() {
  static const std::vector<double> state = [] {
    auto c = mixed_bgk("md-imex-8-3-mixed", 1.0);
    c.time.tolerance.reset();
    c.time.cfl.reset();
    c.time.dt = c.time.end / 40000;
    return at_the_end(c);
  }();
  return state;
}

/// Checks errors and steps as tests/integrate/tolerance_table.cpp does for the ODE model.
void check_mixed_bgk(const std::string& method, const std::vector<double>& tolerances) {
  long before = 0;
  for (const double tolerance : tolerances) {
    apsis::simulation run(mixed_bgk(method, tolerance));
    finish(run);
    const double error = relative(run.state(), converged());
    const auto trace = testing::Message()
                       << method << ", tolerance " << tolerance << ": " << run.step() << " steps, error "
                       << error << ", forecast " << run.expected_plateau();
    if (before > 0) {
      EXPECT_LE(run.step(), 30 * before) << trace;
    }
    EXPECT_LE(error, 25 * std::max(tolerance, run.expected_plateau())) << trace;
    before =
        std::max(run.step(), 2L);  // a single step is as long as time.cfl allows, not as the tolerance does
  }
}

}  // namespace

TEST(tolerance_of_mixed_bgk, costs_at_most_30_per_decade_and_is_kept_or_warned_about) {
  check_mixed_bgk("md-imex-8-3-mixed", {1e-3, 1e-4, 1e-5, 1e-6, 1e-7});
  check_mixed_bgk("md-imex-3-2", {1e-3, 1e-4, 1e-5, 1e-6, 1e-7});
}

TEST(tolerance_of_mixed_bgk, is_not_forecast_for_explicit_methods) {
  // Explicit methods resolve the relaxation or are unstable, so no term of size epsilon remains.
  testing::internal::CaptureStderr();
  const apsis::simulation run(mixed_bgk("dop853", 1e-7));
  EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::Not(HasSubstr("terms of size epsilon")));
}

TEST(tolerance_of_mixed_bgk, is_warned_about_if_the_first_step_skips_the_initial_layer) {
  // One step of ark-436 has an error of 3e-3, but its embedded solution agrees with it to 1e-4.
  const auto words_of = [](apsis::case_config c) {
    testing::internal::CaptureStderr();
    const apsis::simulation run(c);
    return testing::internal::GetCapturedStderr();
  };
  auto c = mixed_bgk("ark-436", 1e-4);
  EXPECT_THAT(words_of(c), testing::Not(HasSubstr("initial layer")));
  c.time.startup = apsis::startup_choice::none;
  EXPECT_THAT(words_of(c), HasSubstr("give time.startup = \"graded\""));
  c.time.method = "ars-443";  // step doubling
  EXPECT_THAT(words_of(c), HasSubstr("initial layer"));
  EXPECT_THAT(words_of(mixed_bgk("md-imex-8-3-mixed", 1e-4)), testing::Not(HasSubstr("initial layer")));
}

TEST(SLOW_tolerance_of_mixed_bgk, costs_at_most_30_per_decade_and_is_kept_or_warned_about_with_all_methods) {
  for (const auto& method :
       methods_where([](const apsis::method& m) { return m.embedded && m.kind == apsis::method_kind::imex; }))
    check_mixed_bgk(method, {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9});
}

}  // namespace tolerance_test
