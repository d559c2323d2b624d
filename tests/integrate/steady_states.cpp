// Some methods keep steady states. The coefficients predict which ones, and a step confirms it.
#include <apsis/method/steady_states.hpp>

#include "support/catalogue.hpp"

#include <apsis/integrate/integrate.hpp>
#include <apsis/integrate/newton_problem.hpp>
#include <apsis/method/precision.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace steady_states_test {

namespace {

using real = long double;
using state = std::vector<real>;

/// Returns the relative change in a step from the steady state of u' = T(u) + Q(u)/ε with T(u) = 1 + u/2 and
/// Q(u)/ε = −10u². Neither term vanishes there, and the rate of relaxation is 20u* = 6.8.
real moved(const std::string& method, real dt) {
  auto problem =
      apsis::make_newton_problem<state>([](real, const state& u, state& out) { out[0] = 1 + u[0] / 2; },
                                        [](const auto& u, auto& out) { out[0] = -10 * u[0] * u[0]; });
  const real steady = (0.5L + std::sqrt(40.25L)) / 20;
  apsis::stepper march(apsis::find_method(method), problem);
  state u{steady};
  apsis::integrate(march, u, real(0), dt, apsis::step_rule<real>::fixed(dt));
  return std::abs(u[0] - steady) / steady;
}

class steady_states : public testing::TestWithParam<std::string> {};

}  // namespace

TEST_P(steady_states, are_left_by_a_step_where_the_coefficients_say_so) {
  const auto m = apsis::to_butcher(apsis::find_method(GetParam()).coefficients<apsis::mp_real>());
  const bool stays = apsis::steady_state_defect(m) < 1e-30;
  // Steps are from ε/10 to 10 ε. Newton's method solves stages to double precision or better.
  for (const real dt : {0.01L, 0.1L, 1.0L}) {
    if (stays) {
      EXPECT_LT(moved(GetParam(), dt), 1e-13L) << dt;
    } else {
      EXPECT_GT(moved(GetParam(), dt), 1e-9L) << dt;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(catalogue, steady_states,
                         testing::ValuesIn(methods_where([](const apsis::method& m) {
                           return m.kind == apsis::method_kind::imex;
                         })),
                         test_name);

TEST(steady_states, are_those_of_the_equation_for_schemes_without_second_derivatives_and_equal_nodes) {
  const auto defect = [](const std::string& name) {
    return static_cast<double>(apsis::steady_state_defect(
        apsis::to_butcher(apsis::find_method(name).coefficients<apsis::mp_real>())));
  };
  EXPECT_LT(defect("ars-443"), 1e-30);
  EXPECT_LT(defect("forward-backward-euler"), 1e-30);
  EXPECT_GT(defect("md-imex-8-3-mixed"), 1e-3);
}

}  // namespace steady_states_test
