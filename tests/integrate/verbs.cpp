// combine() and project_to_equilibrium() of problems that define them, and the defaults for other problems.
#include <apsis/integrate/verbs.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/relaxation_weights.hpp>
#include <apsis/integrate/exact_collisions.hpp>
#include <apsis/integrate/newton_problem.hpp>
#include <apsis/integrate/relaxation_problem.hpp>

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace verbs_test {

namespace {

using testing::ElementsAre;

/// A state without arithmetic.
struct pair_state {
  double first = 0.0, second = 0.0;
};

/// q relaxes to p² with the rate 2/ε. T must not be evaluated.
template <class State>
struct without_verbs {
  using state = State;
  using real = double;
  double epsilon = 1.0;

  static double& p(pair_state& u) { return u.first; }
  static double& q(pair_state& u) { return u.second; }
  static double& p(std::vector<double>& u) { return u[0]; }
  static double& q(std::vector<double>& u) { return u[1]; }

  void add_transport(double, const state& u, std::span<const apsis::target<state, double>> targets) {
    for (const auto& to : targets) {
      if (to.beta != 0.0) throw apsis::numerical_error("T was evaluated");
      state of = u;
      p(*to.acc) = to.combine(p(*to.acc), p(of), 0.0);
      q(*to.acc) = to.combine(q(*to.acc), q(of), 0.0);
    }
  }
  void solve_collision(double, double a, double b, state& u) {
    const auto weights = apsis::relax_weights(a, b, 2.0, epsilon);
    q(u) = weights.of_u * q(u) + weights.of_e * (p(u) * p(u));
  }
  double forward_euler_step(double, const state&) const { return 1.0; }
};

template <class State>
State state_of(double p, double q) {
  State u;
  if constexpr (std::is_same_v<State, std::vector<double>>) u.resize(2);
  without_verbs<State>::p(u) = p;
  without_verbs<State>::q(u) = q;
  return u;
}

template <class State>
class verbs : public testing::Test {};
using states = testing::Types<pair_state, std::vector<double>>;
TYPED_TEST_SUITE(verbs, states);

}  // namespace

TYPED_TEST(verbs, combine_adds_in_order_and_overwrites_the_sum) {
  without_verbs<TypeParam> problem;
  static_assert(!apsis::problem_with_combination<without_verbs<TypeParam>>);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto u = state_of<TypeParam>(1.0, 3.0), v = state_of<TypeParam>(1e16, -2.0),
             w = state_of<TypeParam>(-1e16, 0.5);
  auto sum = state_of<TypeParam>(nan, nan);
  apsis::combine(problem, {{2.0, &v}, {1.0, &u}, {2.0, &w}}, sum);
  EXPECT_EQ(problem.p(sum), (2e16 + 1.0) - 2e16);  // 0 or 2, not 1
  EXPECT_EQ(problem.q(sum), 0.0);
}

TYPED_TEST(verbs, combine_changes_the_state_of_its_first_term_in_place) {
  without_verbs<TypeParam> problem;
  auto u = state_of<TypeParam>(1.0, 3.0);
  const auto v = state_of<TypeParam>(10.0, 100.0);
  apsis::combine(problem, {{1.0, &u}, {-2.0, &v}}, u);
  EXPECT_EQ(problem.p(u), -19.0);
  EXPECT_EQ(problem.q(u), -197.0);
  apsis::combine(problem, {{-0.5, &u}, {1.0, &v}}, u);
  EXPECT_EQ(problem.p(u), 19.5);
  EXPECT_EQ(problem.q(u), 198.5);
}

TYPED_TEST(verbs, projection_keeps_moments_and_leads_to_equilibrium_for_every_epsilon) {
  for (const double epsilon : {0.0, 1e-30, 1.0, 1e30}) {
    without_verbs<TypeParam> problem{epsilon};
    auto u = state_of<TypeParam>(1.5, -7.0);
    apsis::project_to_equilibrium(problem, 0.0, u);
    EXPECT_EQ(problem.p(u), 1.5) << epsilon;
    EXPECT_EQ(problem.q(u), 2.25) << epsilon;
  }
}

RC_GTEST_PROP(verbs, of_a_relaxation_project_to_the_equilibrium_that_stages_approach, ()) {
  const auto number = [] { return *rc::gen::inRange(-1000, 1001) / 100.0; };
  const double epsilon = std::pow(10.0, -*rc::gen::inRange(0, 13));
  apsis::relaxation_problem problem(
      [](double, const std::vector<double>&, std::vector<double>&) { throw apsis::input_error("T"); },
      [](const std::vector<double>& u) { return u[0]; },
      [](double omega, std::vector<double>& e) { e = {omega, std::sin(omega)}; }, [](double) { return 1.0; },
      epsilon);
  const double p = number(), q = number();
  std::vector<double> native = {p, q}, stage = native, exact = native;
  apsis::project_to_equilibrium(problem, 0.0, native);
  problem.solve_collision(0.0, apsis::time_to_equilibrium<double>(), 0.0, stage);
  apsis::exact_collisions exponential(problem);
  apsis::project_to_equilibrium(exponential, 0.0, exact);
  RC_ASSERT(native == (std::vector<double>{p, std::sin(p)}));
  RC_ASSERT(exact == native);
  RC_ASSERT(std::abs(stage[1] - native[1]) <= 1e-90);
}

TEST(projections, leave_a_state_that_does_not_relax_unchanged) {
  apsis::relaxation_problem problem(
      apsis::no_transport{}, [](const std::vector<double>& u) { return u[0]; },
      [](double omega, std::vector<double>& e) { e = {omega, 0.0}; }, [](double) { return 0.0; }, 0.0);
  std::vector<double> u = {2.0, 5.0};
  apsis::project_to_equilibrium(problem, 0.0, u);
  EXPECT_THAT(u, ElementsAre(2.0, 5.0));
}

TEST(projections, report_a_state_that_is_not_finite) {
  apsis::relaxation_problem problem(
      apsis::no_transport{}, [](const std::vector<double>& u) { return u[0]; },
      [](double omega, std::vector<double>& e) { e = {omega, std::sqrt(omega)}; }, [](double) { return 1.0; },
      1e-3);
  std::vector<double> u = {-1.0, 5.0};
  EXPECT_THROW(apsis::project_to_equilibrium(problem, 0.0, u), apsis::numerical_error);
}

}  // namespace verbs_test
