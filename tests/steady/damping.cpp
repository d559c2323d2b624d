// The pseudo-time term of J: when it appears, when it grows, and when no stronger one exists.
#include <apsis/steady/damping.hpp>

#include <apsis/core/errors.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace damping_test {

using apsis::damping;

TEST(damping, is_absent_while_the_residual_falls_and_corrections_are_small) {
  damping term;
  for (double residual = 1.0; residual > 1e-12; residual *= 0.8) {
    EXPECT_FALSE(term.note_residual(residual));
    EXPECT_FALSE(term.note_change(damping::largest_change));
  }
  EXPECT_EQ(term.strength(), 0);
  EXPECT_EQ(term.vanishing_rate(1.0), 0.0);
  EXPECT_EQ(term.constant_rate(), 0.0);
}

TEST(damping, comes_with_the_first_large_correction_and_vanishes_with_the_residual) {
  damping term;
  EXPECT_TRUE(term.note_change(1.1 * damping::largest_change));
  EXPECT_FALSE(term.note_change(1.1 * damping::largest_change));
  EXPECT_EQ(term.strength(), 1);
  EXPECT_GT(term.vanishing_rate(1.0), 0.0);
  EXPECT_DOUBLE_EQ(term.vanishing_rate(1e-3), 1e-3 * term.vanishing_rate(1.0));
  EXPECT_EQ(term.vanishing_rate(50.0), term.vanishing_rate(1.0));
  EXPECT_EQ(term.constant_rate(), 0.0);
}

TEST(damping, grows_where_corrections_stay_too_large) {
  damping term;
  int iterations = 0;
  for (double residual = 1.0; term.strength() < 2; residual *= 0.8) {
    ++iterations;
    term.note_residual(residual);
    term.note_change(2.0);
    ASSERT_LT(iterations, 50);
  }
  EXPECT_GT(iterations, 8);  // strong flows may need as many iterations
}

TEST(damping, does_not_vanish_where_a_small_residual_stays) {
  damping term;
  for (int k = 0; k < 60; ++k) term.note_residual(1e-5);
  EXPECT_GT(term.constant_rate(), 0.0);
}

TEST(damping, gives_up_when_the_strongest_term_does_not_help) {
  damping term;
  const auto stay = [&] {
    for (int k = 0; k < 1000; ++k) {
      const int before = term.strength();
      const bool stronger = term.note_residual(0.5);
      EXPECT_EQ(stronger, term.strength() > before);
    }
  };
  bad_input::expect_refused({
      {stay, {"the residual stays at 0.5 of that of the start for 100 iterations"}, 3},
  });
}

}  // namespace damping_test
