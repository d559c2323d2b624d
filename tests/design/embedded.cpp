// Embedded solutions: the least squares behind them, what is found, and what is not.
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

namespace apsis {
namespace {

embedded_search search_for(const std::string& name, int order = 0,
                           embedded_cost cost = embedded_cost::one_solve) {
  embedded_task task;
  task.order = order;
  task.cost = cost;
  return find_embedded(find_method(name), task);
}

embedded_certificate certified(const std::string& name, const embedded_row& row) {
  method m = find_method(name);
  m.embedded = row;
  const auto c = certify(m);
  EXPECT_TRUE(c.claims_hold) << name << ": " << (c.failures.empty() ? "" : c.failures.front());
  return *c.embedded;
}

/// The first-order conditions, which decide in a convex problem: no gradient along a positive x, and none
/// that would let a zero grow.
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
      // Nearly dependent columns have large x, and gradients that are as large as its rounding.
      const bool flat = gradient(j) >= -1e-9 * (1.0 + x.maxCoeff());
      RC_ASSERT(x(j) == 0.0 || flat);
    }
  });
}

/// Rounding once let the entry that blocks a step keep a last digit, and the search ended away from the
/// minimum.
TEST(nonnegative_least_squares, goes_on_where_a_step_is_blocked) {
  Eigen::MatrixXd A(2, 6);
  A << -1.0, -1.0, -1.0, -0.13, -1.0, -0.39, -1.0, -1.0, -1.0, -0.44, -1.0, -0.87;
  const Eigen::VectorXd b = Eigen::Vector2d(-0.08, -1.0);
  const Eigen::VectorXd x = nonnegative_least_squares<double>(A, b, 1e-12);
  // The fourth column alone: (0.13 · 0.08 + 0.44) / (0.13² + 0.44²).
  EXPECT_NEAR(x(3), 0.4504 / 0.2105, 1e-14);
  EXPECT_EQ(x.sum(), x(3));
}

/// What the files hold is what is found: the highest order that serves, and that row.
void expect_found_again(const std::string& name) {
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

TEST(embedded_solution, of_the_catalogue_is_found_again) {
  for (const auto& name : methods_where([](const method& m) { return m.embedded && m.claims.order < 4; }))
    expect_found_again(name);
}

TEST(embedded_solution, of_fourth_order_methods_is_found_again_slow) {
  for (const auto& name : methods_where([](const method& m) { return m.embedded && m.claims.order >= 4; }))
    expect_found_again(name);
}

TEST(embedded_solution, is_a_multiple_of_the_taylor_term_where_it_can_be) {
  // Implicit methods have two trees of order 3; two of five unknowns are left by the equations.
  const auto e = certified("imdrk-3-3", *search_for("imdrk-3-3").found);
  EXPECT_EQ(e.order, 2);
  EXPECT_NEAR(e.alignment.convert_to<double>(), 1.0, 1e-30);
  EXPECT_NEAR(e.estimate.convert_to<double>(), 0.1 * std::hypot(1.0 / 3.0, 1.0 / 6.0), 1e-15);
  embedded_task half;
  half.parts = 2;
  const auto larger = certified("imdrk-3-3", *find_embedded(find_method("imdrk-3-3"), half).found);
  EXPECT_NEAR((larger.estimate / e.estimate).convert_to<double>(), 5.0, 1e-12);
}

/// c̃ = Σ p̃_j c_j = 1 cannot be where every stage but the last has c_j < 1: the nearest point is far from it.
TEST(embedded_solution, cannot_be_free_where_all_earlier_stages_lie_before_the_end) {
  for (const char* name : {"md-imex-3-2", "imdrk-3-3", "md-imex-5-2"}) {
    const auto search = search_for(name, 0, embedded_cost::nothing);
    EXPECT_FALSE(search.found) << name;
    for (const auto& tried : search.attempts) EXPECT_GT(tried.nearest, 0.1) << name << " " << tried.order;
    EXPECT_EQ(search.attempts.size(), static_cast<std::size_t>(find_method(name).claims.order - 1));
  }
}

TEST(embedded_solution, is_free_where_stages_lie_around_the_end) {
  // imdrk-9-5 has c = 1.42 at a stage.
  const auto search = search_for("imdrk-9-5", 0, embedded_cost::nothing);
  ASSERT_TRUE(search.found);
  const auto e = certified("imdrk-9-5", *search.found);
  EXPECT_EQ(e.order, 1);
  EXPECT_EQ(e.implicit_solves, 0);
  EXPECT_FALSE(e.relaxes);
  // An explicit method knows T of its stages anyway.
  const auto explicit_search = search_for("ssprk-3-3", 0, embedded_cost::nothing);
  ASSERT_TRUE(explicit_search.found);
  EXPECT_EQ(certified("ssprk-3-3", *explicit_search.found).order, 2);
}

TEST(embedded_solution, is_none_where_only_the_method_itself_has_the_order) {
  // The row of u^{n+1} satisfies the equations and says nothing; its 45 digits are what `nearest` shows.
  for (const char* name : {"imdrk-7-4", "md-imex-16-4-large-r"}) {
    const auto search = search_for(name, 3);
    EXPECT_FALSE(search.found) << name;
    ASSERT_EQ(search.attempts.size(), 1U);
    EXPECT_LT(search.attempts[0].nearest, 1e-15) << name;
    EXPECT_LT(search.attempts[0].seen, 1e-15) << name;
  }
  // md-imex-6-3 has others, but they hardly see the limit.
  const auto search = search_for("md-imex-6-3", 2);
  EXPECT_FALSE(search.found);
  EXPECT_GT(search.attempts[0].seen, 0.001);
}

TEST(embedded_solution, keeps_the_margin_that_is_asked_for) {
  embedded_task task;
  task.margin = 0.75;  // imdrk-7-4 has 0.46 without it
  const auto search = find_embedded(find_method("imdrk-7-4"), task);
  ASSERT_TRUE(search.found);
  const auto e = certified("imdrk-7-4", *search.found);
  EXPECT_EQ(e.order, 2);
  EXPECT_GE(coefficient_value(search.found->d) - coefficient_value(search.found->ddot), mp_real(0.75));
}

TEST(embedded_solution, is_refused_where_the_form_has_no_place_for_it) {
  EXPECT_THROW(search_for("ars-443"), input_error);                 // D below the diagonal
  EXPECT_THROW(search_for("forward-backward-euler"), input_error);  // order 1
  EXPECT_THROW(search_for("md-imex-3-2", 2), input_error);          // not below its order
  EXPECT_THROW(search_for("md-imex-3-2", -1), input_error);
  EXPECT_THROW(search_for("ssprk-3-3"), input_error);  // nothing to solve
}

}  // namespace
}  // namespace apsis
