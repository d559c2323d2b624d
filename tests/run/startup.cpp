// time.startup = "graded" in a production run.
#include "ode_runs.hpp"

#include <apsis/core/errors.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace startup_test {

namespace {

apsis::case_config ode(const std::string& method, const std::string& epsilon, const std::string& startup,
                       const std::string& more = "") {
  return apsis::parse_case("[model]\nname = \"ode\"\nepsilon = " + epsilon + "\n" + more +
                               "[time]\nmethod = \"" + method +
                               "\"\nend = 1.0\ndt = 0.00390625\nstartup = \"" + startup + "\"\n",
                           "c.toml");
}

const std::string out_of_equilibrium, near_equilibrium = "initial = \"given\"\nu1 = 2.0\nu2 = 0.90930499\n";

/// Stops after `steps`, continues in a new run, and compares it with an uninterrupted one.
void expect_same_after_restart(const apsis::case_config& c, long steps) {
  apsis::simulation whole(c), first(c), second(c);
  for (long k = 0; k < steps; ++k) {
    whole.advance();
    first.advance();
  }
  second.restore(first.save());
  EXPECT_EQ(second.dt(), whole.dt());
  EXPECT_EQ(second.steps_total(), whole.steps_total());
  EXPECT_EQ(rest_of(whole), rest_of(second)) << steps;
  EXPECT_EQ(whole.summary().startup_steps, second.summary().startup_steps);
}

}  // namespace

TEST(startup, resolves_the_layer_of_the_ode_model) {
  const double consistent = error_at_one(ode("md-imex-4-2", "1e-4", "none", near_equilibrium));
  const double resolved = error_at_one(ode("md-imex-4-2", "1e-4", "graded", out_of_equilibrium));
  EXPECT_LT(resolved, 2 * consistent);
  EXPECT_LT(10 * resolved, error_at_one(ode("md-imex-3-2", "1e-4", "graded", out_of_equilibrium)));
  EXPECT_LT(10 * resolved, error_at_one(ode("md-imex-4-2", "1e-4", "none", out_of_equilibrium)));
}

TEST(startup, counts_its_steps_and_keeps_all_later_times) {
  apsis::simulation run(ode("md-imex-4-2", "1e-4", "graded"));
  EXPECT_EQ(run.steps_total(), 266);
  for (int k = 0; k < 11; ++k) run.advance();
  EXPECT_EQ(run.t(), 0.00390625);
  finish(run);
  EXPECT_EQ(run.summary().startup_steps, 11);  // 1 + ceil(log2(4 · 5/(256 ε)))
  EXPECT_EQ(run.summary().steps, 266);
  EXPECT_EQ(run.t(), 1.0);
  EXPECT_EQ(finished(ode("md-imex-4-2", "1e-4", "none")).startup_steps, 0);
  const auto limit = finished(ode("md-imex-4-2", "0", "graded"));
  EXPECT_EQ(limit.startup_steps, 1);
  EXPECT_EQ(limit.steps, 256);
}

TEST(startup, restarts_in_its_middle_bit_for_bit) {
  for (const long steps : {0L, 1L, 5L, 10L, 11L, 12L})
    expect_same_after_restart(ode("md-imex-4-2", "1e-4", "graded"), steps);
  for (const char* rule : {"cfl", "safety"}) {
    auto c = small("md-imex-4-2", "finite-difference");
    c.model.epsilon = "1e-6 + x";
    c.time.startup = apsis::startup_choice::graded;
    c.time.end = 0.01;
    c.time.cfl.reset();
    (rule[0] == 'c' ? c.time.cfl : c.time.safety) = rule[0] == 'c' ? 0.3 : 1.0;
    for (const long steps : {3L, 14L}) expect_same_after_restart(c, steps);
    c.time.startup_growth = 8;
    for (const long steps : {1L, 3L, 5L}) expect_same_after_restart(c, steps);
  }
}

TEST(startup, takes_fewer_steps_with_a_larger_ratio) {
  // The first step is 5·4/(256·1e-4) = 781 times as long as the shortest one, which is 2^9.6 with doubling
  // times. With fourfold times the shortest step is twice as long, so the ratio is 4^4.3. With eightfold
  // times it is four times as long, and the ratio is 8^2.5.
  for (const auto& [growth, steps] : std::vector<std::pair<int, long>>{{2, 11}, {4, 6}, {8, 4}}) {
    auto c = ode("extrapolated-euler-7", "1e-4", "graded");
    c.time.startup_growth = growth;
    EXPECT_EQ(finished(c).startup_steps, steps) << growth;
  }
}

TEST(startup, follows_the_smallest_epsilon_of_the_mesh_and_keeps_the_promises) {
  for (const auto how : {"finite-volume", "finite-difference"}) {
    auto c = small("md-imex-4-2", how);
    c.time.startup = apsis::startup_choice::graded;
    c.time.cfl.reset();
    c.time.safety = 1.0;
    const auto steps = [&](const std::string& epsilon) {
      c.model.epsilon = epsilon;
      apsis::simulation run(c);
      EXPECT_TRUE(run.promises().positivity) << epsilon;
      const double allowed = run.summary().dt;
      EXPECT_EQ(allowed, 0.0);
      finish(run);  // throws where a promise is broken
      EXPECT_EQ(run.summary().negative_values, 0);
      return run.summary().startup_steps;
    };
    // ε ranges from 1e-6 to 1. Each factor of a thousand in ε costs ten steps.
    const long spread = steps("10^(-6*(x < 1 ? 1 : 2 - x))"), thin = steps("1e-6"), wide = steps("1e-3");
    EXPECT_EQ(spread, thin);
    EXPECT_NEAR(static_cast<double>(thin - wide), 10.0, 1.0);
    EXPECT_EQ(steps("x < 1 ? 0 : 1e-6"), thin);  // cells with ε = 0 have no layer
    EXPECT_EQ(steps("0"), 1);
    EXPECT_EQ(steps("1e12"), 1);
    EXPECT_LE(steps("1e-60"), 56);
  }
}

}  // namespace startup_test
