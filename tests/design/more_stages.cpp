// Additional stages do not change the step, and a search can use them.
#include <apsis/design/more_stages.hpp>

#include <apsis/design/search.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/order_conditions.hpp>
#include <apsis/method/trees.hpp>

#include <gtest/gtest.h>

namespace apsis::more_stages_test {
namespace {

// New stages have no weight in the result. All elementary weights stay equal up to the rounding of sums of
// numbers of size 1.
TEST(more_stages, leave_the_step_unchanged) {
  const auto given = find_method("md-imex-8-3").coefficients<double>();
  const auto trees = rooted_trees(4, tree_colours::both);
  const auto weights = elementary_weights(to_butcher(given), trees);
  random_source random(3);
  for (int repetition = 0; repetition < 20; ++repetition) {
    const auto more = with_more_stages(given, 11, random);
    ASSERT_EQ(more.stages(), 11U);
    const auto same = elementary_weights(to_butcher(more), trees);
    for (std::size_t k = 0; k < trees.size(); ++k) EXPECT_NEAR(same[k], weights[k], 1e-13) << trees[k].name;
    for (std::size_t i = 0; i < more.stages(); ++i) {
      EXPECT_GE(initial_weights(more)[i], -1e-15);
      EXPECT_GT(more.D(i, i) - more.ddot[i], 0.0);
    }
  }
}

TEST(more_stages, are_none_if_the_method_has_enough) {
  const auto given = find_method("md-imex-5-2").coefficients<double>();
  random_source random(1);
  EXPECT_EQ(with_more_stages(given, 5, random).stages(), 5U);
}

// A method of second order with three evaluations gets a fourth one at a new stage. r rises from 2 to at
// least 2.4, as it does without a new stage (design_search.adds_evaluations_to_a_method).
TEST(more_stages, can_evaluate_transport) {
  design_task task;
  task.stages = 6;
  task.transports = 4;
  task.demands.order = 2;
  task.from = find_method("md-imex-5-2").coefficients<double>();
  design_search_options options;
  options.starts = 3;
  const auto found = search_methods(task, options);
  ASSERT_TRUE(found.best);
  EXPECT_EQ(found.feasible, 3);
  EXPECT_EQ(found.best->pattern.stages(), 6U);
  EXPECT_GT(found.best->r, 2.4);
}

}  // namespace
}  // namespace apsis::more_stages_test
