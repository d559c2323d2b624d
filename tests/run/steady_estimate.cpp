// Estimates for time.steady: the rate of change, and the distance from the steady state that follows
// from its decay.
#include <apsis/run/steady_estimate.hpp>

#include "gas_between_walls.hpp"

#include <apsis/output/table.hpp>
#include <apsis/run/session.hpp>

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steady_estimate_test {

using namespace apsis;
using testing::HasSubstr;

namespace {

template <class Change>
numeric_table history_of(const Change& change, double end, int steps) {
  numeric_table rows;
  rows.columns = {"step", "t", "change"};
  rows.rows.push_back({0.0, 0.0, std::nan("")});
  for (int k = 1; k <= steps; ++k) rows.rows.push_back({1.0 * k, end * k / steps, change(end * k / steps)});
  return rows;
}

}  // namespace

TEST(a_steady_estimate, of_an_exponential_decay_is_exact) {
  const auto found =
      estimate_steady_state(history_of([](double t) { return 3.0 * std::exp(-t / 7.0); }, 20.0, 500));
  EXPECT_NEAR(found.decay_time, 7.0, 1e-9);
  EXPECT_NEAR(found.distance, 7.0 * found.change, 1e-9);
}

TEST(a_steady_estimate, follows_the_slowest_part_of_the_last_halving) {
  const auto found = estimate_steady_state(
      history_of([](double t) { return std::exp(-t) + 1e-3 * std::exp(-t / 50.0); }, 60.0, 3000));
  EXPECT_NEAR(found.decay_time, 50.0, 0.5);
}

TEST(a_steady_estimate, of_a_change_that_does_not_decay_is_unknown) {
  for (const auto& change : {+[](double) { return 1e-6; }, +[](double t) { return 1e-6 * (1.0 + 0.1 * t); },
                             +[](double t) { return 1e-6 * (1.0 + 0.2 * std::sin(9.0 * t)); }}) {
    const auto found = estimate_steady_state(history_of(change, 10.0, 300));
    EXPECT_FALSE(found.has_distance());
    EXPECT_THAT(to_text(found), HasSubstr("unknown: the change does not decay"));
  }
  EXPECT_FALSE(estimate_steady_state(numeric_table{}).has_distance());
}

TEST(a_steady_estimate, of_a_gas_between_plates_is_the_distance_of_a_longer_run) {
  // Δt/ε = 1. The diffusion of heat across the gap takes 20 units of time.
  const auto with = [](const char* steady) {
    return between_walls::case_of({"md-imex-8-3-mixed",
                                   fmt::format("cfl = 0.8\nend = 2000\nsteady = {}", steady), "",
                                   "formulation = \"finite-difference\"", "0.01"});
  };
  run_session early(with("1e-4"), {}), late(with("1e-9"), {});
  early.run();
  late.run();
  const auto found = estimate_steady_state(early.records().history());
  const auto here = early.computed().state(), there = late.computed().state();
  const double distance = between_walls::distance(here, there) /
                          between_walls::distance(here, std::vector<double>(here.size(), 0.0));
  ASSERT_TRUE(found.has_distance());
  // The distance is several hundred times as large as time.steady. One more slow mode is 30 % of it.
  EXPECT_GT(distance, 1e-4);
  EXPECT_NEAR(found.distance / distance, 1.0, 0.3);
  const auto json = to_json(early.computed(), early.records());
  EXPECT_TRUE(json["steady"]["reached"].get<bool>());
  EXPECT_EQ(json["steady"]["distance"].get<double>(), found.distance);
}

/// Steps as long as epsilon move the steady state of methods with second derivatives, for any time.steady.
TEST(a_steady_estimate, a_method_whose_steady_state_depends_on_the_step_warns_of_it) {
  const auto warnings = [](const std::string& method, const std::string& time) {
    run_session run(
        between_walls::case_of({method, time, "", "formulation = \"finite-difference\"", "0.003"}), {});
    run.run();
    return run.warnings();
  };
  const auto about_steps =
      testing::Contains(HasSubstr("the steady state of method 'md-imex-8-3-mixed' depends on dt C/epsilon"));
  EXPECT_THAT(warnings("md-imex-8-3-mixed", "cfl = 0.8\nend = 0.1\nsteady = 1e-4"), about_steps);
  EXPECT_THAT(warnings("md-imex-8-3-mixed", "cfl = 0.8\nend = 0.1"), testing::Not(about_steps));
  EXPECT_THAT(warnings("md-imex-8-3-mixed", "dt = 0.0005\nend = 0.01\nsteady = 1e-4"),
              testing::Not(about_steps));
  EXPECT_THAT(warnings("bhr-553", "cfl = 0.2\nend = 0.1\nsteady = 1e-4"),
              testing::Not(testing::Contains(HasSubstr("depends on dt C/epsilon"))));
}

}  // namespace steady_estimate_test
