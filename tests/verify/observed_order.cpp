// Observed orders for a user-defined problem type.
#include <apsis/verify/observed_order.hpp>

#include <apsis/integrate/relaxation_problem.hpp>

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace observed_order_test {

using namespace apsis;

namespace {

// The quickstart problem, u1' = u2, u2' = (sin u1 − u2)/ε.
auto problem_with(double epsilon) {
  using state = std::vector<double>;
  return relaxation_problem(
      [](double, const state& u, state& T) { T = {u[1], 0.0}; }, [](const state& u) { return u[0]; },
      [](double w, state& E) { E = {w, std::sin(w)}; }, [](double) { return 1.0; }, epsilon);
}

double l1(const std::vector<double>& a, const std::vector<double>& b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]);
}

}  // namespace

TEST(observed_order, is_that_of_the_method_at_both_ends_of_epsilon) {
  for (const double epsilon : {1.0, 1e-12}) {
    auto problem = problem_with(epsilon);
    for (const auto& [name, order] : {std::pair{"md-imex-3-2", 2.0}, {"md-imex-6-3", 3.0}}) {
      const auto rows =
          observed_orders(find_method(name), problem, {2.0, 0.0}, 0.0, 1.0, {64, 128, 192, 384}, l1);
      ASSERT_EQ(rows.size(), 3U);
      EXPECT_TRUE(std::isnan(rows[0].order));
      // Differences of runs with the step ratios 2, 1.5 and 2 scale as powers only between equal ratios.
      EXPECT_NEAR(std::log(rows[0].error / rows[2].error) / std::log(3.0), order, 0.1)
          << name << " " << epsilon;
    }
  }
}

TEST(observed_order, against_a_reference_takes_any_ratio_of_steps) {
  auto problem = problem_with(1.0);
  const auto& m = find_method("md-imex-6-3");
  std::vector<double> reference{2.0, 0.0};
  stepper march(m, problem);
  integrate(march, reference, 0.0, 1.0, step_rule<double>::fixed(1.0 / 4096));
  const auto rows = observed_orders(m, problem, {2.0, 0.0}, 0.0, 1.0, {50, 70, 210}, reference, l1);
  for (std::size_t k = 1; k < rows.size(); ++k) EXPECT_NEAR(rows[k].order, 3.0, 0.1);
  EXPECT_EQ(rows[2].steps, 210);
  EXPECT_DOUBLE_EQ(rows[2].dt, 1.0 / 210);
}

TEST(observed_order, of_no_runs_is_no_rows) {
  auto problem = problem_with(1.0);
  EXPECT_TRUE(observed_orders(find_method("md-imex-3-2"), problem, {2.0, 0.0}, 0.0, 1.0, {}, l1).empty());
}

}  // namespace observed_order_test
