// A problem gives the same numbers for every state type: standard vectors, Eigen vectors, fixed arrays, long
// double, and a class that has only size() and [].
#include <apsis/integrate/integrate.hpp>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <integrate/ode_model.hpp>

namespace states_test {

namespace {

/// Compilers contract multiply–adds differently for each container. The tolerance covers a few ulps of 3 in
/// 64 steps.
constexpr double rounding = 1e-14;

/// A minimal array_state: no arithmetic, no iterators.
class plain_pair {
 public:
  std::size_t size() const { return 2; }
  double& operator[](std::size_t i) { return i == 0 ? first_ : second_; }
  double operator[](std::size_t i) const { return i == 0 ? first_ : second_; }

 private:
  double first_ = 0, second_ = 0;
};

template <class State, class Problem>
State solved(Problem problem, const std::string& method = "md-imex-6-3") {
  using real = apsis::state_real<State>;
  static_assert(apsis::problem_with_explicit_collision<Problem>);
  apsis::stepper march(apsis::find_method(method), problem);
  State u = ode_model::initial_state<State>();
  apsis::integrate(march, u, real(0), real(1), apsis::step_rule<real>::fixed(real(1) / 64));
  return u;
}

TEST(states, relaxation_does_not_depend_on_the_container) {
  const double epsilon = 1e-2;
  const auto standard = solved<std::vector<double>>(ode_model::as_relaxation(epsilon));
  const auto eigen = solved<Eigen::VectorXd>(ode_model::as_relaxation<Eigen::VectorXd>(epsilon));
  const auto fixed = solved<Eigen::Vector2d>(ode_model::as_relaxation<Eigen::Vector2d>(epsilon));
  const auto array = solved<std::array<double, 2>>(ode_model::as_relaxation<std::array<double, 2>>(epsilon));
  const auto plain = solved<plain_pair>(ode_model::as_relaxation<plain_pair>(epsilon));
  for (std::size_t k = 0; k < 2; ++k) {
    const Eigen::Index i = static_cast<Eigen::Index>(k);
    EXPECT_NEAR(standard[k], eigen[i], rounding);
    EXPECT_NEAR(standard[k], fixed[i], rounding);
    EXPECT_NEAR(standard[k], array[k], rounding);
    EXPECT_NEAR(standard[k], plain[k], rounding);
  }
}

TEST(states, newton_does_not_depend_on_the_container) {
  const double epsilon = 1e-2;
  const auto standard = solved<std::vector<double>>(ode_model::as_newton(epsilon));
  const auto eigen = solved<Eigen::VectorXd>(ode_model::as_newton<Eigen::VectorXd>(epsilon));
  const auto plain = solved<plain_pair>(ode_model::as_newton<plain_pair>(epsilon));
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(standard[k], eigen[static_cast<Eigen::Index>(k)], rounding);
    EXPECT_NEAR(standard[k], plain[k], rounding);
  }
}

TEST(states, both_problem_types_and_precisions_give_the_same_solution) {
  const double epsilon = 1e-2;
  const auto closed = solved<std::vector<double>>(ode_model::as_relaxation(epsilon));
  const auto newton = solved<std::vector<double>>(ode_model::as_newton(epsilon));
  using extended = std::vector<long double>;
  const auto closed_extended = solved<extended>(ode_model::as_relaxation<extended>(1e-2L));
  const auto newton_extended = solved<extended>(ode_model::as_newton<extended>(1e-2L));
  for (std::size_t k = 0; k < 2; ++k) {
    // 64 steps of six stages, each accurate to a few rounding errors of numbers below 3.
    EXPECT_NEAR(closed[k], newton[k], 1e-13);
    EXPECT_NEAR(static_cast<double>(closed_extended[k] - newton_extended[k]), 0, 1e-16);
    EXPECT_NEAR(static_cast<double>(closed_extended[k] - static_cast<long double>(closed[k])), 0, 1e-13);
  }
}

}  // namespace

}  // namespace states_test
