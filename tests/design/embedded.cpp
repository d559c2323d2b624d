// Solutions of lower order beside a method.
#include <apsis/design/embedded.hpp>

#include <apsis/method/order_conditions.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace apsis {
namespace {

embedded_search look(const std::string& name, embedded_cost cost) {
  const method& m = find_method(name);
  return find_embedded(m.coefficients<double>(), m.kind, m.claims.order, cost);
}

/// Order conditions by the Butcher form, signs, and the rows of the method as they were.
void expect_good(const std::string& name, const embedded_solution& found) {
  const method& m = find_method(name);
  const auto base = m.coefficients<double>();
  const auto& e = found.extended;
  const std::size_t s = base.stages();
  ASSERT_EQ(e.stages(), s + 1);
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      EXPECT_EQ(e.P(i, j), base.P(i, j));
      EXPECT_EQ(e.W(i, j), base.W(i, j));
      EXPECT_EQ(e.D(i, j), base.D(i, j));
    }
  EXPECT_EQ(e.P(s, s - 1), 0.0) << "u^{n+1} itself";
  for (std::size_t j = 0; j < s; ++j) EXPECT_GE(e.P(s, j) + e.W(s, j), 0.0);
  // Row sums and conditions hold as far as the search goes, 1e-11.
  EXPECT_GE(initial_weights(e)[s], -1e-11);
  const auto trees =
      rooted_trees(m.claims.order, m.kind == method_kind::imex ? tree_colours::both : tree_colours::G_only);
  const auto weights = elementary_weights(to_butcher(e), trees);
  double next = 0.0;
  for (std::size_t t = 0; t < trees.size(); ++t) {
    const double missing = weights[t] - 1.0 / trees[t].density;
    if (trees[t].order < m.claims.order) {
      EXPECT_NEAR(missing, 0.0, 1e-10) << name << " " << trees[t].name;
    } else {
      next += missing * missing;
    }
  }
  EXPECT_NEAR(std::sqrt(next), found.error, 1e-9);
  EXPECT_GT(found.error, 1e-4) << "an estimate that is zero estimates nothing";
}

TEST(embedded, costs_one_solve_for_every_imex_method_of_the_paper_and_beyond) {
  for (const std::string name : {"md-imex-3-2", "md-imex-5-2", "md-imex-6-3", "md-imex-8-3"}) {
    const auto result = look(name, embedded_cost::one_solve);
    ASSERT_TRUE(result.found) << name << " " << result.nearest;
    expect_good(name, *result.found);
  }
}

// c_i < 1 at all stages but the last one, and a convex combination of smaller numbers is smaller than 1.
TEST(embedded, cannot_cost_nothing_where_no_stage_reaches_the_end_of_the_step) {
  for (const std::string name : {"md-imex-3-2", "md-imex-5-2"}) {
    const auto b = to_butcher(find_method(name).coefficients<double>());
    for (std::size_t i = 0; i + 1 < b.stages(); ++i) {
      double c = 0.0;
      for (std::size_t j = 0; j <= i; ++j) c += b.A(i, j);
      EXPECT_LT(c, 1.0);
    }
    const auto result = look(name, embedded_cost::nothing);
    EXPECT_FALSE(result.found);
    EXPECT_GT(result.nearest, 1e-3);
  }
}

}  // namespace
}  // namespace apsis
