#include <apsis/core/graded_start.hpp>

#include <numeric>

#include <gtest/gtest.h>

namespace graded_start_test {

namespace {

TEST(graded_start, divides_the_step_into_steps_whose_times_grow_by_the_ratio) {
  for (const int growth : {2, 3, 4, 8, 64})
    for (const double relaxation_time : {1.2, 4e-3, 4e-9}) {
      const auto steps = apsis::graded_start(0.25, relaxation_time, growth);
      const double longest = growth / 8.0 * relaxation_time;
      // Times of powers of two are exact. With the ratio 3 each time is rounded once.
      EXPECT_NEAR(std::accumulate(steps.begin(), steps.end(), 0.0), 0.25, growth == 3 ? 1e-15 : 0.0);
      EXPECT_LE(steps.front(), longest);
      double time = steps.front();
      for (std::size_t k = 1; k < steps.size(); ++k) {
        EXPECT_NEAR(steps[k], (growth - 1) * time, growth == 3 ? 1e-15 : 0.0) << growth << ' ' << k;
        time += steps[k];
      }
      if (steps.size() > 1) {
        EXPECT_GT(growth * steps.front() * (1.0 + 1e-15), longest);  // no more steps than needed
      }
    }
}

TEST(graded_start, keeps_short_steps_and_steps_without_a_layer) {
  EXPECT_EQ(apsis::graded_start(0.25, 1.0), std::vector<double>{0.25});
  EXPECT_EQ(apsis::graded_start(0.25, 0.25, 8), std::vector<double>{0.25});
  EXPECT_EQ(apsis::graded_start(0.25, 0.0), std::vector<double>{0.25});  // ε = 0
}

TEST(graded_start, ends_for_layers_below_rounding_whatever_the_ratio) {
  // There are as many halvings as a double has digits, plus two. 2^−55, 4^−28 and 64^−10 agree to
  // within one step.
  EXPECT_EQ(apsis::graded_start(1.0, 1e-300).size(), 56U);
  EXPECT_EQ(apsis::graded_start(1.0, 1e-300, 4).size(), 29U);
  EXPECT_EQ(apsis::graded_start(1.0, 1e-300, 64).size(), 11U);
}

}  // namespace

}  // namespace graded_start_test
