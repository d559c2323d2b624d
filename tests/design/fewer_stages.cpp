// Removing stages from a method. The smaller method satisfies the demands. If no stage can be removed, the
// residual weight is reported.
#include <apsis/design/fewer_stages.hpp>

#include <apsis/method/method.hpp>
#include <apsis/method/order_conditions.hpp>
#include <apsis/method/trees.hpp>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace apsis::fewer_stages_test {
namespace {

design_task task_like(const method& m, int order) {
  design_task task;
  task.kind = m.kind;
  task.stages = m.stages();
  task.demands.order = order;
  return task;
}

/// Returns the largest |weight − 1/γ| of the trees up to an order. It uses the Butcher form and no code of
/// the design.
double order_residual(const shu_osher_form<double>& m, int order) {
  const auto trees = rooted_trees(order, tree_colours::both);
  const auto weights = elementary_weights(to_butcher(m), trees);
  double worst = 0.0;
  for (std::size_t k = 0; k < trees.size(); ++k)
    worst = std::max(worst, std::abs(weights[k] - 1.0 / trees[k].density));
  return worst;
}

// Third order needs only six of the eight stages (md-imex-6-3).
TEST(fewer_stages, keep_order_and_signs) {
  const method& m = find_method("md-imex-8-3-accurate");
  const auto task = task_like(m, 3);
  const auto smaller = without_a_stage(task, m.coefficients<double>());
  ASSERT_TRUE(smaller);
  EXPECT_EQ(smaller->stages(), m.stages() - 1);
  // The equations are solved to 1e-11.
  EXPECT_LT(order_residual(*smaller, 3), 1e-10);
  for (std::size_t i = 0; i < smaller->stages(); ++i) {
    EXPECT_GE(initial_weights(*smaller)[i], -1e-12);
    EXPECT_GE(smaller->D(i, i), 0.0);
    EXPECT_LE(smaller->ddot[i], 0.0);
    EXPECT_GE(smaller->D(i, i) - smaller->ddot[i], task.demands.margin - 1e-12);
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GE(smaller->P(i, j), 0.0);
      EXPECT_GE(smaller->W(i, j), 0.0);
    }
  }
}

// Order 3 without transport needs two stages, so neither stage of imdrk-2-3 can be removed.
TEST(fewer_stages, reports_the_residual_weight_if_all_are_needed) {
  const method& m = find_method("imdrk-2-3");
  std::size_t tried = 0;
  double least = 1.0;
  const auto smaller =
      without_a_stage(task_like(m, 3), m.coefficients<double>(), {}, [&](std::size_t, double left) {
        ++tried;
        least = std::min(least, left);
      });
  EXPECT_FALSE(smaller);
  EXPECT_EQ(tried, m.stages() - 1);
  EXPECT_GT(least, 1e-3);
}

}  // namespace
}  // namespace apsis::fewer_stages_test
