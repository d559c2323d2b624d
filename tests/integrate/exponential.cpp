// Exponential methods in the stepper: exact relaxation, observed order, the limit ε → 0, positivity up to the
// step bound.
#include <apsis/integrate/exact_collisions.hpp>
#include <apsis/integrate/integrate.hpp>
#include <apsis/integrate/relaxation_problem.hpp>
#include <apsis/integrate/stepper.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <integrate/ode_model.hpp>
#include <integrate/reference.hpp>
#include <support/bad_input.hpp>

namespace exponential_test {

namespace {

/// Returns u(1) of a problem after equal steps.
template <class Problem, class State = typename Problem::state>
State solve(Problem problem, State u, long steps) {
  using real = typename Problem::real;
  apsis::exact_collisions exact(problem);
  apsis::stepper march(apsis::find_method("exponential-2"), exact);
  apsis::integrate(march, u, real(0), real(1),
                   apsis::step_rule<real>::fixed(real(1) / static_cast<real>(steps)));
  return u;
}

using state = std::vector<long double>;

TEST(exponential, flow_weights_are_exact_in_the_limits) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double epsilon : {0.0, 1e-300}) {
    EXPECT_EQ(apsis::flow_weights(1.0, 2.0, epsilon).of_u, 0.0);
    EXPECT_EQ(apsis::flow_weights(1.0, 2.0, epsilon).of_e, 1.0);
    EXPECT_EQ(apsis::flow_weights(0.0, 2.0, epsilon).of_u, 1.0);
    EXPECT_EQ(apsis::flow_weights(1.0, 0.0, epsilon).of_e, 0.0);
  }
  EXPECT_EQ(apsis::flow_weights(1.0, 1.0, infinity).of_u, 1.0);
  EXPECT_TRUE(std::isnan(apsis::flow_weights(1.0, std::nan(""), 1.0).of_u));
  // The smaller weight is accurate at any size: 1 − e^{−z} = z up to z²/2.
  EXPECT_DOUBLE_EQ(apsis::flow_weights(1e-20, 1.0, 1.0).of_e, 1e-20);
  EXPECT_DOUBLE_EQ(apsis::flow_weights(700.0, 1.0, 1.0).of_u, std::exp(-700.0));
}

TEST(exponential, flow_weights_sum_to_one_and_are_accurate) {
  for (double z = 1e-18; z < 700.0; z *= 1.0371) {
    const auto weights = apsis::flow_weights(z, 1.0, 1.0);
    EXPECT_EQ(weights.of_u + weights.of_e, 1.0) << z;
    const long double exact = static_cast<long double>(z);
    // An ulp of a number x is at most 2.3e-16 x.
    EXPECT_NEAR(static_cast<double>(weights.of_u / std::exp(-exact)), 1.0, 3e-16) << z;
    EXPECT_NEAR(static_cast<double>(weights.of_e / -std::expm1(-exact)), 1.0, 3e-16) << z;
  }
}

TEST(exponential, methods_and_problems_that_do_not_belong_together_are_refused) {
  auto problem = ode_model::as_relaxation<state>(1.0L);
  apsis::exact_collisions exact(problem);
  bad_input::expect_refused({
      {[&] { const apsis::stepper march(apsis::find_method("exponential-2"), problem); },
       {"method 'exponential-2' cannot integrate this problem (it is exponential, and the collisions of "
        "the problem are not solved exactly); wrap the problem in exact_collisions"}},
      {[&] { const apsis::stepper march(apsis::find_method("md-imex-3-2"), exact); },
       {"method 'md-imex-3-2' cannot integrate this problem (its collisions are solved exactly, and the "
        "method is not exponential)"}},
  });
}

TEST(exponential, relaxation_without_transport_is_exact_for_any_step) {
  for (const double epsilon : {10.0, 0.3, 0.01}) {
    auto problem = apsis::make_relaxation_problem<std::vector<double>>(
        apsis::no_transport{}, [](const auto& u) { return u[0]; },
        [](double w, auto& out) { out = {w, std::sin(w)}; }, [](double w) { return 1 + w * w; }, epsilon);
    const auto u = solve(problem, std::vector<double>{2, 0}, 3);
    EXPECT_EQ(u[0], 2.0);
    // The tolerance covers the rounding errors of twelve combinations, relative to E.
    EXPECT_NEAR(u[1], -std::sin(2.0) * std::expm1(-5 / epsilon), 1e-15);
  }
}

TEST(exponential, observed_order_is_two) {
  const auto exact = reference::radau(1, 1);
  double error[2];
  for (int i = 0; i < 2; ++i) {
    const auto u = solve(ode_model::as_relaxation<state>(1.0L), state{2, 0}, 128L << i);
    error[i] = static_cast<double>(std::abs(u[0] - exact[0]) + std::abs(u[1] - exact[1]));
  }
  // At these steps the second error term is a hundredth of the first.
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2.0, 0.05);
}

// The first exact collision takes the data to equilibrium before T is evaluated. The method therefore
// preserves the asymptotic limit for any data.
TEST(exponential, has_its_order_in_the_limit_from_data_out_of_equilibrium) {
  const auto exact = reference::limit(1);
  for (const long double epsilon : {0.0L, 1e-17L}) {
    double moment[2], rest[2];
    for (int i = 0; i < 2; ++i) {
      const auto u = solve(ode_model::as_relaxation<state>(epsilon), state{2, 0}, 128L << i);
      moment[i] = static_cast<double>(std::abs(u[0] - exact[0]));
      rest[i] = static_cast<double>(std::abs(u[1] - exact[1]));
      // The last operation is an exact collision, so the result is in equilibrium.
      EXPECT_NEAR(static_cast<double>(u[1] - std::sin(u[0])), 0.0, 1e-18);
    }
    EXPECT_NEAR(std::log2(moment[0] / moment[1]), 2.0, 0.05);
    EXPECT_NEAR(std::log2(rest[0] / rest[1]), 2.0, 0.05);
  }
}

/// Returns the smallest value after ten steps of Δt = courant Δx. A single full cell is advected upwind and
/// relaxes towards the mean.
double smallest_value(double courant, double epsilon) {
  constexpr std::size_t cells = 32;
  auto problem = apsis::make_relaxation_problem<std::vector<double>>(
      [](double, const auto& u, auto& out) {
        for (std::size_t i = 0; i < cells; ++i) out[i] = u[(i + cells - 1) % cells] - u[i];
      },
      [](const auto& u) { return std::accumulate(u.begin(), u.end(), 0.0); },
      [](double w, auto& out) { out.assign(cells, w / cells); }, [](double) { return 1.0; }, epsilon);
  apsis::exact_collisions exact(problem);
  apsis::stepper march(apsis::find_method("exponential-2"), exact);
  EXPECT_EQ(march.require_ssp_coefficient(), 1.0);
  std::vector<double> u(cells, 0.0);
  u[0] = 1.0;
  double smallest = 0.0;
  for (int n = 0; n < 10; ++n) {
    march.step(0.0, courant, u);
    smallest = std::min(smallest, *std::min_element(u.begin(), u.end()));
  }
  return smallest;
}

TEST(exponential, values_stay_nonnegative_up_to_the_step_bound_and_not_above) {
  for (double epsilon = 1e-8; epsilon < 1e9; epsilon *= 10)
    EXPECT_GE(smallest_value(1.0, epsilon), 0.0) << epsilon;
  // Without collision the neighbour of the full cell receives ν(1 − ν), half of it in each stage. This is
  // negative for ν > 1.
  EXPECT_LT(smallest_value(1.05, 1e6), -0.04);
  EXPECT_LT(smallest_value(1.001, 1e9), -5e-4);
}

}  // namespace

}  // namespace exponential_test
