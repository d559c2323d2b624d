// Runs with exponential methods: the results of a step, conservation, promises, observed order, the limit ε →
// 0, and models whose collisions have no known solution.
#include "gas_between_walls.hpp"

#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/integrate/stepper.hpp>
#include <apsis/method/method.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace exponential_run_test {

namespace {

using namespace apsis;
using between_walls::distance, between_walls::end_of;

constexpr const char* name = "exponential-2";

/// Returns a case in which ε varies within the cells.
case_config gas(const std::string& space, const std::string& time, const std::string& epsilon = "0.01 + x") {
  return between_walls::case_of({.method = name, .time = time, .space = space, .epsilon = epsilon});
}

const std::vector<std::string> spaces = {"formulation = \"finite-difference\"",
                                         "formulation = \"finite-volume\"",
                                         "formulation = \"finite-volume\"\ncollisions = \"centres\"",
                                         "formulation = \"finite-volume\"\nreconstruction = \"upwind1\""};

}  // namespace

// Two collisions of times s and t equal one of time s + t. Only the exact solution satisfies this identity.
TEST(exponential_run, collisions_of_a_case_are_exact) {
  const case_config c = gas(spaces[0], "dt = 0.001\nend = 0.01\n");
  const run_setup setup(c);
  const auto problem = setup.make_problem();
  ASSERT_TRUE(problem->collides_exactly());
  field once = setup.initial_state();
  // A large step of transport takes the state out of equilibrium.
  stepper march(find_method(name), *problem);
  march.step(0.0, 0.01, once);
  field twice = once;
  const field before = once;
  problem->solve_collision(0.0, 0.05, 0.0, once);
  problem->solve_collision(0.0, 0.02, 0.0, twice);
  problem->solve_collision(0.0, 0.03, 0.0, twice);
  double moved = 0.0;
  for (int cell = 0; cell < once.cells(); ++cell)
    for (int k = 0; k < once.components(); ++k) {
      EXPECT_NEAR(once.row(cell)[k], twice.row(cell)[k], 1e-15) << cell << " " << k;
      moved = std::max(moved, std::abs(once.row(cell)[k] - before.row(cell)[k]));
    }
  EXPECT_GT(moved, 1e-3);
}

TEST(exponential_run, keeps_conservation_and_positivity_in_every_discretization) {
  for (const auto& space : spaces) {
    const bool first_order = space.find("upwind1") != std::string::npos;
    simulation run(gas(space + (first_order ? "" : "\nlimiter = \"positivity\""), "safety = 1\nend = 0.1\n"));
    EXPECT_TRUE(run.promises().conservation) << space;
    EXPECT_TRUE(run.promises().positivity) << space;
    while (!run.finished()) run.advance();
    // There are some hundred steps of a few roundings each. The energy through the walls is 1e-2.
    EXPECT_LT(run.summary().conservation_defect, 1e-12) << space;
    EXPECT_GE(run.summary().min_value, 0.0) << space;
    EXPECT_EQ(run.summary().negative_values, 0) << space;
  }
}

TEST(exponential_run, observed_order_is_two) {
  for (const auto& space : spaces) {
    const auto at = [&](long steps) {
      return end_of(gas(space, fmt::format("dt = {:.17g}\nend = 0.02\n", 0.02 / static_cast<double>(steps)),
                        "0.1 + x"));
    };
    const auto exact = at(1280);
    // The limiter at the Gauss points of averages leaves errors of 1e-8, which finer steps would reach.
    const double coarse = distance(at(40), exact), fine = distance(at(80), exact);
    // The reference has 1/256 of the error of the finer run.
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.15) << space;
  }
}

TEST(exponential_run, becomes_the_explicit_scheme_of_the_limit) {
  // For ε = 0 every collision is the projection to equilibrium, as in any method.
  const auto end = [](const char* epsilon) {
    return end_of(gas(spaces[0], "dt = 0.001\nend = 0.05\n", epsilon));
  };
  const auto limit = end("0");
  EXPECT_EQ(end("1e-300"), limit);
  // z = Δt/(3ε) = 33 reduces every deviation to e^{−33} = 3e-15.
  EXPECT_LT(distance(end("1e-5"), limit), 1e-12);
  EXPECT_GT(distance(end("1e-3"), limit), 1e-4);
}

TEST(exponential_run, keeps_a_tolerance_by_step_doubling) {
  const auto exact = end_of(gas(spaces[0], "dt = 1e-4\nend = 0.1\n"));
  double before = 1.0;
  for (const double tolerance : {1e-4, 1e-6}) {
    const auto run = end_of(gas(spaces[0], fmt::format("tolerance = {}\ncfl = 0.5\nend = 0.1\n", tolerance)));
    const double error = distance(run, exact);
    EXPECT_LT(error, 30 * tolerance);
    EXPECT_LT(error, before);
    before = error;
  }
}

}  // namespace exponential_run_test
