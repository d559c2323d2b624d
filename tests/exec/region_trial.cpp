// The choice between all threads and the caller alone, with durations given instead of measured.
#include <apsis/exec/region_trial.hpp>

#include <functional>

#include <gtest/gtest.h>

namespace region_trial_test {

namespace {

using apsis::region_trial;

/// Runs n regions whose duration depends on how they run; returns how many ran on the caller alone.
long run(region_trial& trial, long n, const std::function<double(bool alone)>& seconds) {
  long alone = 0;
  for (long k = 0; k < n; ++k) {
    const bool now = trial.alone();
    alone += now ? 1 : 0;
    trial.add(seconds(now));
  }
  return alone;
}

constexpr long trial_length = 3 * (region_trial::window + region_trial::warm_up);

TEST(region_trial, keeps_the_caller_alone_where_other_threads_are_slower) {
  region_trial trial;
  const auto slower_together = [](bool alone) { return alone ? 10e-6 : 20e-6; };
  run(trial, trial_length, slower_together);
  EXPECT_TRUE(trial.alone());
  // Later trials of the slower way are a small part.
  const long n = 1'000'000;
  EXPECT_GT(static_cast<double>(run(trial, n, slower_together)), 0.98 * n);
}

TEST(region_trial, keeps_all_threads_where_they_are_faster) {
  region_trial trial;
  const auto faster_together = [](bool alone) { return alone ? 20e-6 : 11e-6; };
  const long n = 1'000'000;
  EXPECT_LT(static_cast<double>(run(trial, n, faster_together)), 0.02 * n);
}

TEST(region_trial, changes_its_choice_when_the_machine_changes) {
  region_trial trial;
  run(trial, 100'000, [](bool alone) { return alone ? 20e-6 : 11e-6; });
  const auto reversed = [](bool alone) { return alone ? 11e-6 : 20e-6; };
  run(trial, (region_trial::longest_hold + 1) * region_trial::window + trial_length, reversed);
  EXPECT_TRUE(trial.alone());
}

TEST(region_trial, cancels_a_drift_of_the_clock_rate) {
  // All become 1 % slower within a trial in which both ways differ by .1 %.
  region_trial trial;
  double rate = 1.0;
  run(trial, trial_length, [&](bool alone) {
    rate += 0.01 / static_cast<double>(trial_length);
    return rate * (alone ? 10.01e-6 : 10e-6);
  });
  EXPECT_FALSE(trial.alone());
}

TEST(region_trial, never_runs_long_regions_alone_for_more_than_one) {
  region_trial trial;
  run(trial, trial_length, [](bool alone) { return alone ? 10e-6 : 20e-6; });
  EXPECT_TRUE(trial.alone());
  const auto long_region = [](bool) { return 2 * region_trial::longest; };
  EXPECT_EQ(run(trial, 10'000, long_region), 1);
}

}  // namespace

}  // namespace region_trial_test
