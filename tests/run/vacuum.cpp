// Runs through states on the boundary of the realizable moments, and through vacuum.
#include "cases.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/run/setup.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace vacuum_test {

namespace {

const std::string both[] = {"finite-volume", "finite-difference"};

/// Returns a cold gas with Δv = 2√T that expands into a density of 1e-300.
apsis::case_config expansion(const std::string& how, const std::string& epsilon,
                             apsis::equilibrium_choice equilibrium) {
  auto c = small("md-imex-6-3", how);
  c.model.initial = "expansion";
  c.model.epsilon = epsilon;
  c.velocity = {8.0, 16, equilibrium};
  c.time.end = 0.1;
  return c;
}

double lowest_density(const apsis::simulation& run) {
  const auto rho = run.fields().values.at(0);
  return *std::min_element(rho.begin(), rho.end());
}

}  // namespace

TEST(vacuum, an_expansion_into_vacuum_keeps_its_promises) {
  for (const auto& how : both)
    for (const char* epsilon : {"0", "1e-6", "1"})
      for (const auto equilibrium :
           {apsis::equilibrium_choice::discrete, apsis::equilibrium_choice::automatic}) {
        apsis::simulation run(expansion(how, epsilon, equilibrium));
        ASSERT_TRUE(run.promises().positivity && run.promises().conservation);
        ASSERT_LT(lowest_density(run), 1.1e-300);
        ASSERT_NO_THROW(finish(run)) << epsilon << " " << apsis::choice_name(equilibrium);
        EXPECT_EQ(run.summary().negative_values, 0) << epsilon << " " << apsis::choice_name(equilibrium);
        EXPECT_GT(lowest_density(run), 1e-30) << "the gas did not reach the vacuum: the test is vacuous";
      }
}

TEST(vacuum, the_entropy_decays) {
  for (const char* epsilon : {"0", "1e-3", "1"}) {
    auto c = expansion("finite-difference", epsilon, apsis::equilibrium_choice::discrete);
    c.space.reconstruction = "upwind1";
    apsis::simulation run(c);
    ASSERT_TRUE(run.promises().entropy);
    ASSERT_NO_THROW(finish(run)) << epsilon;
  }
}

TEST(vacuum, holds_in_two_velocity_dimensions) {
  for (const auto& how : both) {
    auto c = expansion(how, "1e-4", apsis::equilibrium_choice::discrete);
    c.model.parameters["velocity_dimensions"] = 2.0;
    c.time.end = 0.02;
    apsis::simulation run(c);
    ASSERT_TRUE(run.promises().positivity && run.promises().conservation);
    ASSERT_NO_THROW(finish(run));
  }
}

TEST(vacuum, rows_of_zeros_of_subnormal_numbers_and_of_one_velocity_are_integrated) {
  for (const auto& how : both) {
    const auto c = expansion(how, "1e-5", apsis::equilibrium_choice::discrete);
    apsis::simulation run(c);
    auto saved = run.save();
    const auto width = static_cast<std::size_t>(run.setup().equation->components());
    const auto value = [&](std::size_t cell, std::size_t k) -> double& {
      return saved.unknowns[cell * width + k];
    };
    for (std::size_t k = 0; k < width; ++k) {
      value(0, k) = value(1, k) = 0.0;
      value(2, k) = std::numeric_limits<double>::denorm_min() * static_cast<double>(k % 3);
      value(9, k) = k == 3 ? 1.0 : 0.0;
      value(10, k) = k == 7 || k == 8 ? 0.5 : 0.0;
      value(11, k) = k == 0 || k == width - 1 ? 0.5 : 0.0;
    }
    // The mass differs from that of the case, so ten steps are taken without promises relative to the start.
    // If half the molecules are at either end of the velocities, these cannot resolve the gas.
    run.restore(saved);
    for (int step = 0; step < 10; ++step) {
      try {
        run.advance();
      } catch (const apsis::numerical_error& failure) {
        const std::string& problem = failure.problem();
        ASSERT_TRUE(problem.find("is not conserved") != std::string::npos ||
                    problem.find("velocity.max = 8 is too small for the gas") != std::string::npos)
            << failure.what();
      }
      ASSERT_EQ(run.last().negative_values, 0) << step;
      ASSERT_EQ(run.step(), step + 1);
    }
  }
}

}  // namespace vacuum_test
