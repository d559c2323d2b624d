// time.tolerance: steps by the estimated error, through the production run.
#include "ode_runs.hpp"
#include "support/catalogue.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/integrate/stepper.hpp>
#include <apsis/run/setup.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using testing::HasSubstr;
using testing::StartsWith;

apsis::case_config ode(const std::string& method, const std::string& more) {
  return apsis::parse_case("[model]\nname = \"ode\"\nepsilon = 1e-2\n[time]\nmethod = \"" + method +
                               "\"\nend = 1.0\ndt = 0.5\n" + more,
                           "c.toml");
}

/// Smallest value of ũ after one step of r Δt_FE.
double smallest_of_embedded(const std::string& method, const std::string& epsilon,
                            const std::string& scheme) {
  const auto c = apsis::load_case(
      "paper/broadwell", {"time.method=" + method, "model.epsilon=" + epsilon,
                          "space.reconstruction=" + scheme, "space.limiter=positivity", "time.safety=1"});
  const apsis::run_setup setup(c);
  const auto problem = setup.make_problem();
  apsis::stepper march(setup.integrator(), *problem, apsis::solutions::result_and_embedded);
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

TEST(tolerance, makes_the_error_as_small_as_is_asked) {
  const double coarse = error_at_one(ode("md-imex-8-3-accurate", "tolerance = 1e-4\n"));
  const double fine = error_at_one(ode("md-imex-8-3-accurate", "tolerance = 1e-7\n"));
  EXPECT_LT(fine, 1e-2 * coarse);
  EXPECT_LT(fine, 1e-5);
  // dt = 0.5 alone, which is now only the longest step, does not see the layer of width 0.002.
  EXPECT_GT(error_at_one(ode("md-imex-8-3-accurate", "")), 1e3 * fine);
}

TEST(tolerance, counts_what_it_rejects_and_keeps_within_the_rule) {
  const auto done = finished(ode("md-imex-8-3", "tolerance = 1e-6\n"));
  EXPECT_GE(done.rejected_steps, 1);
  EXPECT_LE(done.dt, 0.5);
  EXPECT_EQ(done.t, 1.0);
  const auto loose = finished(ode("md-imex-8-3", "tolerance = 1e6\n"));
  EXPECT_EQ(loose.rejected_steps, 0);
  EXPECT_EQ(loose.steps, 2);
}

TEST(tolerance, restarts_to_the_last_digit) {
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
  auto c = small("md-imex-3-2", apsis::formulation::finite_difference);
  c.time.tolerance = 1e-4;
  c.time.end = 0.01;
  expect_same(c, 3);
}

TEST(tolerance, leaves_the_promises_of_the_rule_as_they_are) {
  auto c = small("md-imex-8-3", apsis::formulation::finite_volume);
  c.time.cfl.reset();
  c.time.safety = 1.0;
  c.time.tolerance = 1e-3;
  apsis::simulation run(c);
  EXPECT_TRUE(run.promises().positivity);
  finish(run);  // throws where a promise is broken
  EXPECT_EQ(run.summary().negative_values, 0);
}

TEST(tolerance, is_refused_where_it_cannot_be_kept) {
  const auto complaint = [](const auto& make) -> std::string {
    try {
      const apsis::simulation run(make());
    } catch (const apsis::input_error& e) {
      return e.what();
    }
    return "";
  };
  const std::string none = complaint([] { return ode("ars-443", "tolerance = 1e-3\n"); });
  EXPECT_THAT(none,
              StartsWith("c.toml:8:1: time.tolerance cannot be kept: method 'ars-443' has no embedded"));
  EXPECT_THAT(none, HasSubstr("md-imex-8-3, "));
  EXPECT_THAT(complaint([] { return ode("md-imex-3-2", "tolerance = 1e-3\nstartup = \"graded\"\n"); }),
              HasSubstr("both choose the first steps"));
  EXPECT_THAT(complaint([] { return ode("md-imex-3-2", "tolerance = 0\n"); }), HasSubstr("time.tolerance"));
}

TEST(embedded_solution, is_positive_up_to_the_step_of_the_method_for_any_epsilon) {
  const auto names = methods_where([](const apsis::method& m) {
    return m.embedded && m.kind == apsis::method_kind::imex && m.stages() < 10;
  });
  for (const auto& method : names)
    for (const char* epsilon : {"0", "1e-12", "1e-3", "1", "1e12"})
      for (const char* scheme : {"upwind1", "weno5-z"})
        EXPECT_GE(smallest_of_embedded(method, epsilon, scheme), 0.0)
            << method << " " << epsilon << " " << scheme;
}
