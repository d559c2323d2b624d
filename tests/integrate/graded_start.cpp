#include <apsis/integrate/graded_start.hpp>

#include <numeric>

#include <gtest/gtest.h>

namespace graded_start_test {

namespace {

TEST(graded_start, divides_the_step_into_doubling_steps) {
  for (const double shortest : {0.3, 1e-3, 1e-9}) {
    const auto steps = apsis::graded_start(0.25, shortest);
    EXPECT_EQ(std::accumulate(steps.begin(), steps.end(), 0.0), 0.25);  // powers of two: exact
    EXPECT_LE(steps.front(), shortest);
    for (std::size_t k = 2; k < steps.size(); ++k) EXPECT_EQ(steps[k], 2 * steps[k - 1]);
    if (steps.size() > 1) {
      EXPECT_EQ(steps[1], steps[0]);
      EXPECT_GT(2 * steps.front(), shortest);  // no more steps than needed
    }
  }
}

TEST(graded_start, keeps_short_steps_and_steps_without_a_layer) {
  EXPECT_EQ(apsis::graded_start(0.25, 0.25), std::vector<double>{0.25});
  EXPECT_EQ(apsis::graded_start(0.25, 0.0), std::vector<double>{0.25});  // ε = 0
}

}  // namespace

}  // namespace graded_start_test
