// Every method of the catalogue keeps the promise Δt ≤ r Δt_FE on problems of all kinds.
#include <apsis/study/observed_limits.hpp>

#include "support/catalogue.hpp"

#include <apsis/study/case_problem.hpp>

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace apsis::observed_limits_test {
namespace {

class every_method : public testing::TestWithParam<std::string> {};
TEST_P(every_method, preserves_the_promised_property) {
  const auto all = observe_limits(find_method(GetParam()));
  EXPECT_FALSE(all.empty());
  for (const auto& one : all)
    EXPECT_TRUE(one.keeps_promise()) << one.problem << ", " << one.property << ": " << one.limit.lost << " "
                                     << one.worst;
}
/// Returns methods with many or with few stages. The test takes some tenths of a second per stage.
std::vector<std::string> methods_with(bool many_stages) {
  return methods_where([&](const method& m) { return (m.stages() > 9) == many_stages; });
}

INSTANTIATE_TEST_SUITE_P(catalogue, every_method, testing::ValuesIn(methods_with(false)), test_name);
INSTANTIATE_TEST_SUITE_P(families, every_method,
                         testing::Values("md-imex-chain-5-2", "md-imex-plateau-free-6-2"), test_name);
INSTANTIATE_TEST_SUITE_P(SLOW_catalogue, every_method, testing::ValuesIn(methods_with(true)), test_name);

TEST(observed_limits, third_order_imex_loses_positivity_of_the_broadwell_model_just_above_r) {
  const method& m = find_method("md-imex-6-3");
  for (const auto& one : observe_limits(m)) {
    if (one.problem != "broadwell, WENO5 with limiter, finite-difference") continue;
    EXPECT_NEAR(one.limit.lost, one.promised, 0.005 * one.promised);
    return;
  }
  FAIL() << "no such problem";
}

TEST(observed_limits, forward_euler_steps_of_limited_weno_are_sharp) {
  case_problem weno(small_case("broadwell", "md-imex-3-2", 1.0, 12,
                               {"space.limiter=positivity", "space.formulation=finite-difference"}));
  const auto data = adversarial_states(weno, 10, 1e-8, true);
  // The bisection is accurate to 1e-4 of the step.
  EXPECT_NEAR(largest_forward_euler_step(*weno.equations, std::span<const field>(data), positivity()).kept,
              1.0, 2e-4);
}

}  // namespace
}  // namespace apsis::observed_limits_test
