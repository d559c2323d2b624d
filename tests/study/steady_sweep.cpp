// Steady states along a range of values. Each one starts from the previous one.
#include <apsis/study/steady_sweep.hpp>

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace steady_sweep_test {
namespace {

using apsis::parse_sweep;
using apsis::run_sweep;
using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<std::string> small = {"space.cells=10", "velocity.points=[16, 10]"};

}  // namespace

TEST(steady_sweep, divides_wide_ranges_by_ratios_and_narrow_ones_by_distances) {
  const auto wide = parse_sweep("delta=0.01..100", 5);
  EXPECT_EQ(wide.key, "parameters.delta");
  EXPECT_THAT(wide.values, ElementsAre("0.01", "0.1", "1", "10", "100"));
  EXPECT_THAT(parse_sweep("parameters.U=1..2", 3).values, ElementsAre("1", "1.5", "2"));
  EXPECT_THAT(parse_sweep("parameters.U=-1..1", 3).values, ElementsAre("-1", "0", "1"));
  EXPECT_THAT(parse_sweep("U=0.1,0.4", 9).values, ElementsAre("0.1", "0.4"));
  EXPECT_THROW(parse_sweep("U", 9), apsis::input_error);
  EXPECT_THROW(parse_sweep("U=", 9), apsis::input_error);
  EXPECT_THROW(parse_sweep("U=1,1", 9), apsis::input_error);
}

TEST(steady_sweep, finds_the_states_of_single_runs_in_fewer_iterations) {
  const auto table = run_sweep("gas/couette", small, parse_sweep("delta=8..10", 3));
  ASSERT_EQ(table.rows.size(), 3U);
  for (const auto& row : table.rows) EXPECT_TRUE(row.found) << row.problem;
  const auto alone = run_sweep("gas/couette", small, parse_sweep("delta=10,20", 2));
  const auto shear = static_cast<std::size_t>(
      std::find(table.fluxes.begin(), table.fluxes.end(), "right_momentum_y") - table.fluxes.begin());
  ASSERT_LT(shear, table.fluxes.size());
  // Both are steady to 1e-8 of the initial residual.
  EXPECT_NEAR(table.rows[2].flux[shear], alone.rows[0].flux[shear], 1e-8);
  EXPECT_FALSE(table.rows[0].continued);
  EXPECT_TRUE(table.rows[2].continued);
  EXPECT_LE(table.rows[2].iterations, alone.rows[0].iterations + 2);
}

TEST(steady_sweep, keeps_the_mass_of_each_case) {
  // In the second case the walls enclose twice as much gas, so the pressure doubles. Friction heats the gas
  // by another U².
  const auto table = run_sweep("gas/couette", small, parse_sweep("initial.rho=1,2", 2));
  const auto across = static_cast<std::size_t>(
      std::find(table.fluxes.begin(), table.fluxes.end(), "right_momentum_x") - table.fluxes.begin());
  EXPECT_NEAR(table.rows[1].flux[across] / table.rows[0].flux[across], 2.0, 1e-3);
}

TEST(steady_sweep, goes_on_after_a_state_that_is_not_found) {
  std::vector<std::string> few = small;
  few.emplace_back("steady.iterations=16");
  const auto table = run_sweep("gas/couette", few, parse_sweep("delta=0.01,30,0.011", 3));
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_TRUE(table.rows[0].found);
  EXPECT_FALSE(table.rows[1].found);
  EXPECT_THAT(table.rows[1].problem, HasSubstr("no steady state in 16 iterations"));
  EXPECT_TRUE(table.rows[2].found);
  const auto numbers = apsis::to_table(table);
  EXPECT_TRUE(std::isnan(numbers.rows[1].back()));
  EXPECT_EQ(numbers.rows[2][0], 0.011);
}

TEST(steady_sweep, refuses_an_invalid_value_before_the_first_run) {
  apsis::study_control control;
  int iterations = 0;
  control.progress = [&](double, const std::string&) { ++iterations; };
  EXPECT_THROW(run_sweep("gas/couette", small, parse_sweep("space.cells=10,2", 2), control),
               apsis::input_error);
  EXPECT_THROW(run_sweep("gas/couette", small, parse_sweep("space.no_such=1,2", 2), control),
               apsis::input_error);
  EXPECT_EQ(iterations, 0);
}

TEST(steady_sweep, retains_what_was_found_before_an_interruption) {
  apsis::study_control control;
  int asked = 0;
  control.stop = [&] { return ++asked > 40; };
  const auto table = run_sweep("gas/couette", small, parse_sweep("delta=1..1000", 9), control);
  EXPECT_FALSE(table.complete);
  EXPECT_GE(table.rows.size(), 1U);
  EXPECT_LT(table.rows.size(), 9U);
  for (const auto& row : table.rows) EXPECT_TRUE(row.found);
}

TEST(steady_sweep, draws_fluxes_that_matter) {
  const auto table = run_sweep("gas/fourier", {"space.cells=8"}, parse_sweep("delta=1..10", 3));
  const auto drawn = apsis::to_picture(table);
  ASSERT_EQ(drawn.panels.size(), 3U);                             // momentum, energy, iterations
  EXPECT_LT(drawn.panels[0].curves.size(), table.fluxes.size());  // no mass crosses the walls
  EXPECT_TRUE(drawn.panels[0].log_x);
  EXPECT_TRUE(
      apsis::to_picture(run_sweep("gas/fourier", {"space.cells=8"}, parse_sweep("model.name=bgk,shakhov", 2)))
          .panels.empty());
}

}  // namespace steady_sweep_test
