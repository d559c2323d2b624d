// Every method of the paper's class with transport has its order in time on a PDE, from data out
// of equilibrium, at ε = 1 and in the limit. All runs of a method use the same mesh, so there is
// no spatial error.
#include "support/catalogue.hpp"

#include <apsis/study/convergence.hpp>

#include <string>

#include <gtest/gtest.h>

namespace broadwell_orders_test {

using namespace apsis;

namespace {

double slope(const std::string& method, const std::string& epsilon, const std::string& steps) {
  const convergence_study study{
      .case_name = "paper/broadwell",
      .overrides = {"time.method=" + method, "model.epsilon=" + epsilon, "space.cells=40", "time.end=0.4",
                    "space.reconstruction=weno5-z"},
      .vary = {parse_vary("time.cfl=" + steps)},
      .reference = parse_reference("time")};
  return converge(study).blocks.front().rows.back().rate;
}

class every_asymptotic_preserving_method : public ::testing::TestWithParam<std::string> {};

// At these steps the next term of the error changes the slope by up to 0.1, as in docs/convergence.md.
constexpr double tolerance = 0.15;

TEST_P(every_asymptotic_preserving_method, has_its_order_on_the_broadwell_model) {
  const int order = find_method(GetParam()).claims.order;
  EXPECT_NEAR(slope(GetParam(), "1", "0.2,0.1"), order, tolerance);
  // The steps are so long that errors are far above ten times ε, where all of them stall.
  EXPECT_NEAR(slope(GetParam(), "1e-10", "0.8,0.4"), order, tolerance);
}

INSTANTIATE_TEST_SUITE_P(catalogue, every_asymptotic_preserving_method,
                         ::testing::ValuesIn(methods_where([](const method& m) {
                           return m.kind == method_kind::imex && m.claims.type == "A" && !m.is_tableau();
                         })),
                         test_name);

}  // namespace

}  // namespace broadwell_orders_test
