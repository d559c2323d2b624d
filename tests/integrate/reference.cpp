// The references that the errors of the ODE model are measured against must be right themselves.
#include <integrate/reference.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace {

TEST(reference, two_independent_solvers_agree_to_1e_12) {
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
  // The next term of the expansion is O(ε) smaller, hence 1e-3 for ε ≤ 1e-6; 1e-16 · 1e10 is far below it.
  EXPECT_NEAR(static_cast<double>(distance(1e-6L) / distance(1e-8L)), 100, 0.1);
  EXPECT_NEAR(static_cast<double>(distance(1e-8L) / distance(1e-10L)), 100, 0.1);
}

}  // namespace
