// Gases in the plane and in space between boundaries of all kinds and solid boxes stay nonnegative and
// conserve, for every convex method. Runs have more than 1e9 point·stages.
#include "longest_steps.hpp"
#include "random_boxes.hpp"

#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/method/method.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/catalogue.hpp>

namespace solid_positivity_test {

namespace {

/// Takes steps. Returns false if an open end is too cold for the velocities, or a gas too hot; either
/// ends a run.
bool advance(apsis::simulation& run, int steps, const std::string& text) {
  try {
    for (int step = 0; step < steps; ++step) run.advance();
  } catch (const apsis::numerical_error& failure) {
    EXPECT_THAT(failure.what(), testing::AnyOf(testing::HasSubstr("no Maxwellian has the state outside"),
                                               testing::HasSubstr("is too small for the gas")))
        << text;
    return false;
  }
  return true;
}

/// Runs cases with all convex methods in turn. The completed runs must have this many point·stages. Every
/// other case has steps r Δt_FE. The cases in between have the longest steps that are linearly stable.
void expect_nonnegative(const std::vector<std::string>& models, int dimensions, int steps,
                        double point_stages, unsigned seed) {
  random_boxes cases(seed);
  const auto methods = methods_where(is_convex_at_every_epsilon);
  ASSERT_GE(methods.size(), 15U);
  double done = 0.0, defect = 0.0;
  int runs = 0, ended = 0;
  for (std::size_t k = 0; done < point_stages && !testing::Test::HasFailure(); ++k) {
    const std::string& method = methods[k % methods.size()];
    const std::string text = cases.next(models[k % models.size()], method, dimensions);
    const bool longest = (k + k / methods.size()) % 2 == 0;
    apsis::simulation run(
        apsis::parse_case(text, "random.toml", {longest ? steps_of_positivity(text) : "time.safety=1"}));
    ASSERT_TRUE(run.promises().positivity) << text;
    ASSERT_TRUE(run.promises().conservation) << text;
    const bool is_complete = advance(run, steps, text);
    ++(is_complete ? runs : ended);
    ASSERT_EQ(run.summary().negative_values, 0) << text;
    defect = std::max(defect, run.summary().conservation_defect);
    if (is_complete)
      done += static_cast<double>(run.step()) * static_cast<double>(run.state().size()) *
              static_cast<double>(apsis::find_method(method).stages());
  }
  // The first molecules that cross an empty cell in one long step are hot and fast there. They may end a run.
  // Such runs do not count, and fewer runs end than complete.
  EXPECT_LE(ended, runs);
  std::printf(
      "%d dimensions: %d runs and %d that the velocities ended, %.3g point stages, 0 negative values, "
      "conservation defect %.2g\n",
      dimensions, runs, ended, done, defect);
}

}  // namespace

TEST(solid_positivity, is_lost_in_steps_a_quarter_longer_than_promised) {
  // The bound on the step matters: with longer steps the cases become negative.
  random_boxes cases(7);
  int negative = 0;
  for (int k = 0; k < 6; ++k) {
    const std::string text = cases.next("bgk", "md-imex-6-3", 2);
    apsis::simulation run(apsis::parse_case(text, "random.toml", {steps_of_positivity(text, 1.25)}));
    EXPECT_FALSE(run.promises().positivity);
    for (int step = 0; step < 15; ++step) run.advance();
    negative += run.summary().negative_values > 0 ? 1 : 0;
  }
  EXPECT_GE(negative, 1);
  RecordProperty("negative", negative);
}

TEST(solid_positivity, quick_in_the_plane) {
  expect_nonnegative({"bgk", "shakhov", "es-bgk"}, 2, 10, 2e7, 1);
}

TEST(solid_positivity, quick_in_space) {
  expect_nonnegative({"bgk", "shakhov", "es-bgk"}, 3, 4, 2e7, 2);
}

TEST(SLOW_solid_positivity, holds_for_1e9_point_stages_in_the_plane_and_in_space) {
  expect_nonnegative({"bgk", "bgk", "shakhov", "es-bgk"}, 2, 25, 6e8, 2);
  expect_nonnegative({"bgk", "bgk", "shakhov", "es-bgk"}, 3, 10, 6e8, 3);
}

}  // namespace solid_positivity_test
