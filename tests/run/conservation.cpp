// Conserved quantities change by rounding errors only. Larger defects are detected.
#include "cases.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/method/method.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/run/rounding.hpp>

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace conservation_test {

namespace {

apsis::case_config in_dimensions(int dimensions, int points, double v_max) {
  auto c = mixed("mixed-v", "md-imex-6-3", "finite-volume");
  c.model.parameters["velocity_dimensions"] = dimensions;
  c.velocity = {v_max, points, apsis::equilibrium_choice::automatic};
  c.space.cells = {10};
  return c;
}

/// Returns the message of a run whose state is multiplied by 1 + defect after each step, or "" if
/// no step fails.
std::string message_of(const apsis::case_config& c, double defect, int steps) {
  apsis::simulation run(c);
  try {
    for (int step = 0; step < steps; ++step) {
      run.advance();
      auto saved = run.save();
      for (double& value : saved.unknowns) value *= 1.0 + defect;
      run.restore(saved);
    }
  } catch (const apsis::numerical_error& failure) {
    return failure.what();
  }
  return "";
}

}  // namespace

TEST(conservation, does_not_drift_in_three_velocity_dimensions) {
  auto c = in_dimensions(3, 24, 10.0);
  c.model.epsilon = "0";  // every stage of every cell replaces f by its Maxwellian
  apsis::simulation run(c);
  constexpr int steps = 8;
  for (int step = 0; step < steps; ++step) run.advance();
  // The mass has a rounding error for each of 6 stages per step, 5e-15 in total. Naive sums, which drop the
  // tails, would give 8e-14.
  EXPECT_LE(run.last().conservation_defect[0], 5e-15);
}

TEST(conservation, allows_four_times_the_rounding_for_four_times_the_stages) {
  auto c = small("md-imex-chain-64-2", "finite-volume");
  c.model.epsilon = "0";
  c.time.end = 1.0;
  apsis::simulation run(c);
  for (int step = 0; step < 40; ++step) run.advance();  // throws if conservation is broken
  const auto model = apsis::make_model(c);
  const auto of_step = [&](const char* method) {
    return apsis::rounding_of(apsis::find_method(method).coefficients<double>(), *model).of_step;
  };
  EXPECT_NEAR(of_step("md-imex-chain-64-2") / of_step("md-imex-chain-16-2"), 4.0, 0.2);
}

TEST(conservation, detects_a_factor_of_1e_13_at_the_next_step) {
  for (const auto how : {"finite-volume", "finite-difference"}) {
    const auto c = small("md-imex-6-3", how);
    EXPECT_EQ(message_of(c, 0.0, 10), "");
    for (const double defect : {1e-13, -1e-13, 1e-11}) {
      const std::string message = message_of(c, defect, 2);
      EXPECT_NE(
          message.find("broken promise: mass is not conserved to rounding (a step of md-imex-6-3 explains"),
          std::string::npos)
          << defect << " " << message;
      EXPECT_NE(message.find("use velocity.equilibrium = \"discrete\""), std::string::npos) << message;
      EXPECT_EQ(message.find("smaller step"), std::string::npos) << message;
    }
  }
}

TEST(conservation, detects_a_defect_of_a_single_late_step) {
  // A bound proportional to the number of steps would accept 1e-13 after about twenty steps.
  auto c = small("md-imex-6-3", "finite-difference");
  c.time.end = 10.0;
  apsis::simulation run(c);
  for (int step = 0; step < 300; ++step) run.advance();
  auto saved = run.save();
  for (double& value : saved.unknowns) value *= 1.0 + 1e-13;
  run.restore(saved);
  try {
    run.advance();
    FAIL() << "1e-13 was not noticed";
  } catch (const apsis::numerical_error& failure) {
    EXPECT_NE(std::string(failure.what()).find("mass is not conserved to rounding"), std::string::npos);
  }
}

TEST(conservation, detects_a_defect_of_every_step_in_the_first) {
  const auto c = small("md-imex-6-3", "finite-difference");
  const double rounding =
      apsis::rounding_of(apsis::find_method("md-imex-6-3").coefficients<double>(), *apsis::make_model(c))
          .of_step;
  EXPECT_LT(rounding, 1e-14);
  EXPECT_NE(message_of(c, 10.0 * rounding, 2), "");
}

TEST(conservation, does_not_drift_by_the_rounding_of_weights) {
  // Weights of u and E with the sum 1 ± 1e-17 would change the mass by this factor in every stage, always in
  // the same direction. The runs would end at 8e-15 to 8e-14.
  for (const char* method : {"md-imex-3-2", "md-imex-6-3", "md-imex-8-3-mixed"}) {
    auto c = small(method, "finite-difference");
    c.model.epsilon = "0.7";
    c.time.end = 10.0;
    apsis::simulation run(c);
    for (int step = 0; step < 1200; ++step) run.advance();
    // Sums of some thousand numbers have random errors.
    EXPECT_LT(run.last().conservation_defect[0], 2e-15) << method;
  }
}

TEST(SLOW_conservation, holds_on_grids_where_a_fixed_bound_fails) {
  struct run_of {
    int dimensions, points;
    double v_max;
    const char *method, *epsilon;
    int steps;
  };
  for (const run_of& r :
       {run_of{3, 32, 10.0, "md-imex-6-3", "mixed", 130}, run_of{3, 24, 10.0, "md-imex-6-3", "mixed", 260},
        run_of{2, 150, 15.0, "md-imex-6-3", "mixed", 400},
        run_of{1, 150, 15.0, "md-imex-chain-64-2", "mixed", 200},
        run_of{1, 150, 15.0, "md-imex-chain-64-2", "0", 200}}) {
    auto c = in_dimensions(r.dimensions, r.points, r.v_max);
    if (r.epsilon != std::string("mixed")) c.model.epsilon = r.epsilon;
    c.space.cells = {20};
    c.time.method = r.method;
    c.time.end = 1.0;
    apsis::simulation run(c);
    for (int step = 0; step < r.steps; ++step) run.advance();
    const auto& defects = run.last().conservation_defect;
    const double worst = *std::max_element(defects.begin(), defects.end());
    // There are two rounding errors per stage, which in the worst case have the same sign.
    const auto stages = static_cast<double>(apsis::find_method(r.method).stages());
    EXPECT_LT(worst, 2.3e-16 * stages * r.steps)
        << r.dimensions << " " << r.points << " " << r.method << " " << r.epsilon;
  }
}

}  // namespace conservation_test
