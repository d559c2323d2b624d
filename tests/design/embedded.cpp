// Search for embedded solutions: nonnegative least squares, methods with and without such a solution.
#include <apsis/design/embedded.hpp>

#include "support/catalogue.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/design/nonnegative_least_squares.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/method/coefficient.hpp>

#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <support/property.hpp>

namespace apsis::embedded_test {
namespace {

embedded_search search_for(const std::string& name, int order = 0,
                           embedded_cost cost = embedded_cost::one_solve) {
  embedded_task task;
  task.order = order;
  task.cost = cost;
  return search_embedded(find_method(name), task);
}

embedded_certificate certified(const std::string& name, const embedded_row& row) {
  method m = find_method(name);
  m.embedded = row;
  const auto c = certify(m);
  EXPECT_TRUE(c.claims_hold) << name << ": " << (c.failures.empty() ? "" : c.failures.front());
  return *c.embedded;
}

/// Does x satisfy the first-order conditions? They suffice for a convex problem: the gradient vanishes along
/// positive x, and no descent direction increases a zero.
TEST(nonnegative_least_squares, satisfies_its_optimality_conditions) {
  check_property("random matrices", [] {
    const auto rows = *rc::gen::inRange<Eigen::Index>(1, 9), cols = *rc::gen::inRange<Eigen::Index>(1, 9);
    Eigen::MatrixXd A(rows, cols);
    Eigen::VectorXd b(rows);
    const auto number = [] { return 0.01 * *rc::gen::inRange(-100, 101); };
    for (Eigen::Index i = 0; i < rows; ++i) {
      b(i) = number();
      for (Eigen::Index j = 0; j < cols; ++j) A(i, j) = number();
    }
    const Eigen::VectorXd x = nonnegative_least_squares<double>(A, b, 1e-12);
    const Eigen::VectorXd gradient = A.transpose() * (b - A * x);
    for (Eigen::Index j = 0; j < cols; ++j) {
      RC_ASSERT(x(j) >= 0.0);
      RC_ASSERT(gradient(j) <= 1e-9);
      // Nearly dependent columns give large x. The gradients are then as large as the rounding errors of x.
      const bool flat = gradient(j) >= -1e-9 * (1.0 + x.maxCoeff());
      RC_ASSERT(x(j) == 0.0 || flat);
    }
  });
}

/// Regression: a rounding error once left the blocking entry with a nonzero last digit. The iteration then
/// ended away from the minimum.
TEST(nonnegative_least_squares, continues_after_a_blocked_step) {
  Eigen::MatrixXd A(2, 6);
  A << -1.0, -1.0, -1.0, -0.13, -1.0, -0.39, -1.0, -1.0, -1.0, -0.44, -1.0, -0.87;
  const Eigen::VectorXd b = Eigen::Vector2d(-0.08, -1.0);
  const Eigen::VectorXd x = nonnegative_least_squares<double>(A, b, 1e-12);
  // The solution uses the fourth column alone: (0.13 · 0.08 + 0.44) / (0.13² + 0.44²).
  EXPECT_NEAR(x(3), 0.4504 / 0.2105, 1e-14);
  EXPECT_EQ(x.sum(), x(3));
}

/// Expects that the search reproduces the file: the highest useful order and the same row.
void expect_reproduced(const std::string& name) {
  const method& m = find_method(name);
  const auto search = search_for(name);
  ASSERT_TRUE(search.found) << name;
  EXPECT_EQ(search.found->order, m.embedded->order) << name;
  EXPECT_EQ(search.found->P, m.embedded->P) << name;
  EXPECT_EQ(search.found->W, m.embedded->W) << name;
  EXPECT_EQ(search.found->d, m.embedded->d) << name;
  EXPECT_EQ(search.found->ddot, m.embedded->ddot) << name;
  const auto e = certified(name, *search.found);
  EXPECT_TRUE(e.relaxes);
  EXPECT_EQ(e.explicit_evaluations, 0);
}

/// Returns the methods whose embedded solutions this search found. Other embedded solutions are published
/// with their methods.
std::vector<std::string> searched_methods(int from, int to) {
  return methods_where([&](const method& m) {
    return m.embedded && !m.is_tableau() && m.kind != method_kind::explicit_only && m.claims.order >= from &&
           m.claims.order <= to;
  });
}

TEST(embedded_solution, of_the_catalogue_is_reproduced) {
  for (const auto& name : searched_methods(1, 3)) expect_reproduced(name);
}

TEST(SLOW_embedded_solution, of_methods_of_orders_above_3_is_reproduced) {
  for (const auto& name : searched_methods(4, 99)) expect_reproduced(name);
}

TEST(embedded_solution, is_a_multiple_of_the_taylor_term_if_possible) {
  // Implicit methods have two trees of order 3. The equations leave two of five unknowns free.
  const auto e = certified("imdrk-3-3", *search_for("imdrk-3-3").found);
  EXPECT_EQ(e.order, 2);
  EXPECT_NEAR(e.alignment.convert_to<double>(), 1.0, 1e-30);
  EXPECT_NEAR(e.estimate.convert_to<double>(), std::hypot(1.0 / 3.0, 1.0 / 6.0) / 30, 1e-15);
  embedded_task half;
  half.parts = 2;
  const auto larger = certified("imdrk-3-3", *search_embedded(find_method("imdrk-3-3"), half).found);
  EXPECT_NEAR((larger.estimate / e.estimate).convert_to<double>(), 15.0, 1e-12);
}

/// If all stages but the last have c_j < 1, then c̃ = Σ p̃_j c_j = 1 is impossible. The closest point
/// is far away.
TEST(embedded_solution, has_a_cost_if_all_earlier_abscissae_are_below_1) {
  for (const char* name : {"md-imex-3-2", "imdrk-3-3", "md-imex-5-2"}) {
    const auto search = search_for(name, 0, embedded_cost::nothing);
    EXPECT_FALSE(search.found) << name;
    for (const auto& tried : search.attempts) EXPECT_GT(tried.residual, 0.1) << name << " " << tried.order;
    EXPECT_EQ(search.attempts.size(), static_cast<std::size_t>(find_method(name).claims.order - 1));
  }
}

TEST(embedded_solution, costs_nothing_if_abscissae_lie_on_both_sides_of_1) {
  // One stage of imdrk-9-5 has c = 1.42.
  const auto search = search_for("imdrk-9-5", 0, embedded_cost::nothing);
  ASSERT_TRUE(search.found);
  const auto e = certified("imdrk-9-5", *search.found);
  EXPECT_EQ(e.order, 1);
  EXPECT_EQ(e.implicit_solves, 0);
  EXPECT_FALSE(e.relaxes);
  // In an explicit method T is available at all stages.
  const auto explicit_search = search_for("ssprk-3-3", 0, embedded_cost::nothing);
  ASSERT_TRUE(explicit_search.found);
  EXPECT_EQ(certified("ssprk-3-3", *explicit_search.found).order, 2);
}

TEST(embedded_solution, has_slightly_negative_weights_where_no_convex_one_exists) {
  const auto search = search_for("md-imex-8-3-mixed");
  ASSERT_TRUE(search.found);
  EXPECT_EQ(search.found->order, 2);
  EXPECT_FALSE(search.found->convex);
  mp_real least = 0;
  for (const auto* weights : {&search.found->P, &search.found->W})
    for (const auto& weight : *weights) least = std::min(least, coefficient_value(weight));
  EXPECT_EQ(least, mp_real(-1) / 50);  // 3/5 of θ = 1/30
  EXPECT_LT(search.attempts[0].coverage, 1e-15);
  EXPECT_GT(search.attempts[1].coverage, 0.5);
}

TEST(embedded_solution, does_not_exist_if_only_the_convex_method_itself_has_the_order) {
  // The row of u^{n+1} satisfies the equations but estimates nothing. `residual` is the rounding error of its
  // 45 digits.
  for (const char* name : {"imdrk-7-4", "md-imex-16-4-large-r"}) {
    const auto search = search_for(name, 3);
    EXPECT_TRUE(search.attempts[0].convex);
    EXPECT_LT(search.attempts[0].residual, 1e-15) << name;
    EXPECT_LT(search.attempts[0].coverage, 1e-15) << name;
  }
  // md-imex-6-3 has other solutions, but their coverage in the limit is small.
  const auto search = search_for("md-imex-6-3", 2);
  EXPECT_FALSE(search.found);
  EXPECT_GT(search.attempts[0].coverage, 0.001);
}

TEST(embedded_solution, respects_the_margin) {
  embedded_task task;
  task.margin = 0.75;  // imdrk-7-4 has 0.46 without it
  const auto search = search_embedded(find_method("imdrk-7-4"), task);
  ASSERT_TRUE(search.found);
  const auto e = certified("imdrk-7-4", *search.found);
  EXPECT_EQ(e.order, 2);
  EXPECT_GE(coefficient_value(search.found->d) - coefficient_value(search.found->ddot), mp_real(0.75));
}

TEST(embedded_solution, is_rejected_for_unsupported_methods) {
  EXPECT_THROW(search_for("ars-443"), input_error);                 // D below the diagonal
  EXPECT_THROW(search_for("forward-backward-euler"), input_error);  // order 1
  EXPECT_THROW(search_for("md-imex-3-2", 2), input_error);          // not below its order
  EXPECT_THROW(search_for("md-imex-3-2", -1), input_error);
  EXPECT_THROW(search_for("ssprk-3-3"), input_error);  // no stage solves
}

}  // namespace
}  // namespace apsis::embedded_test
