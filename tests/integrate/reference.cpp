// The reference solutions, from which errors are measured, are accurate.
#include <integrate/reference.hpp>

#include <apsis/integrate/extrapolation.hpp>

#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <integrate/ode_model.hpp>

namespace reference_test {

namespace {

TEST(reference, two_independent_solvers_agree_to_1e_12) {
  if (!reference::has_cvode) GTEST_SKIP() << "SUNDIALS was not found";
  for (const double epsilon : {1.0, 1e-1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10}) {
    const auto radau = reference::radau(epsilon, 1);
    const auto cvode = reference::cvode(epsilon, 1);
    EXPECT_LT(std::abs(radau[0] - cvode[0]), 1e-12L) << epsilon;
    EXPECT_LT(std::abs(radau[1] - cvode[1]), 1e-12L) << epsilon;
  }
}

TEST(reference, distance_to_the_exact_limit_solution_is_proportional_to_epsilon) {
  const auto limit = reference::limit(1);
  const auto distance = [&](long double epsilon) {
    const auto u = reference::radau(epsilon, 1);
    return std::abs(u[0] - limit[0]) + std::abs(u[1] - limit[1]);
  };
  // The next term of the expansion is smaller by a factor O(ε), so the tolerance is 1e-3 for ε ≤ 1e-6. The
  // error of the reference, 1e-16 · 1e10, is far below it.
  EXPECT_NEAR(static_cast<double>(distance(1e-6L) / distance(1e-8L)), 100, 0.1);
  EXPECT_NEAR(static_cast<double>(distance(1e-8L) / distance(1e-10L)), 100, 0.1);
}

using state = std::array<long double, 2>;

constexpr auto distance = [](const state& a, const state& b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]);
};

state extrapolated(long double epsilon, apsis::extrapolation_options<long double> options,
                   long* steps = nullptr) {
  auto problem = ode_model::as_relaxation<state>(epsilon);
  auto u = ode_model::initial_state<state>();
  const long n = apsis::extrapolate(problem, u, 0.0L, 1.0L, options, distance);
  if (steps != nullptr) *steps = n;
  return u;
}

TEST(extrapolation, agrees_with_both_solvers_for_every_epsilon) {
  if (!reference::has_cvode) GTEST_SKIP() << "SUNDIALS was not found";
  for (const double epsilon : {1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10}) {
    long steps = 0;
    const auto u = extrapolated(epsilon, {1e-13L}, &steps);
    const auto radau = reference::radau(epsilon, 1);
    const auto cvode = reference::cvode(epsilon, 1);
    EXPECT_LT(distance(u, {radau[0], radau[1]}), 1e-13L) << epsilon;
    EXPECT_LT(distance(u, {cvode[0], cvode[1]}), 2e-12L) << epsilon;  // accuracy of CVODE, see above
    EXPECT_LT(steps, 5000) << epsilon;  // an explicit method needs more than 1/ε steps
  }
}

TEST(extrapolation, error_decreases_with_the_tolerance) {
  for (const double epsilon : {1.0, 1e-3, 1e-8})
    for (const int order : {4, 6, 8}) {
      const auto radau = reference::radau(epsilon, 1);
      const auto error = [&](long double tolerance) {
        return distance(extrapolated(epsilon, {tolerance, 0, order}), {radau[0], radau[1]});
      };
      // The tolerance of a step, times the number of steps, bounds the error. Estimates are often
      // far too pessimistic.
      EXPECT_LT(error(1e-6L), 1e-5L) << epsilon << " " << order;
      EXPECT_LT(error(1e-10L), 1e-9L) << epsilon << " " << order;
    }
}

TEST(extrapolation, epsilon_zero_gives_the_limit) {
  const auto u = extrapolated(0.0L, {1e-13L});
  const auto limit = reference::limit(1);
  EXPECT_LT(distance(u, {limit[0], limit[1]}), 1e-13L);
}

TEST(extrapolation, throws_if_the_tolerance_cannot_be_met) {
  EXPECT_THROW(extrapolated(1.0L, {1e-24L, 0, 8, 1000}), apsis::numerical_error);
}

}  // namespace

}  // namespace reference_test
