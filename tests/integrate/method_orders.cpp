// The stepper shows the order of every method of the catalogue, far from the limit ε → 0 and in
// the limit. There it must agree with the certificate for the given initial data. The tests
// include new methods automatically.
#include "support/catalogue.hpp"

#include <apsis/integrate/exact_collisions.hpp>
#include <apsis/integrate/integrate.hpp>
#include <apsis/method/certificate.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <integrate/ode_model.hpp>
#include <integrate/reference.hpp>

namespace method_orders_test {

namespace {

using apsis::certificate;
using apsis::method_kind;
using apsis::step_rule;
using real = long double;  // errors of fourth-order methods are far above its rounding, but not always above
                           // that of double
using state = std::vector<real>;

state solve(const std::string& method, real epsilon, long steps, state u) {
  auto problem = ode_model::as_relaxation<state>(epsilon);
  const auto rule = step_rule<real>::fixed(real(1) / static_cast<real>(steps));
  const apsis::method& m = apsis::find_method(method);
  if (m.kind == method_kind::exact_collision) {
    apsis::exact_collisions exact(problem);
    apsis::stepper march(m, exact);
    apsis::integrate(march, u, real(0), real(1), rule);
  } else {
    apsis::stepper march(m, problem);
    apsis::integrate(march, u, real(0), real(1), rule);
  }
  return u;
}

/// Returns the error for u' = −10u² from u(0) = 1/10. The solution 1/(10 + 10t) is slow enough to
/// observe the order.
double decay_error(const std::string& method, long steps) {
  const auto g = [](const auto& u, auto& out) { out[0] = -10 * u[0] * u[0]; };
  auto problem = apsis::make_newton_problem<state>(apsis::no_transport{}, g);
  apsis::stepper march(apsis::find_method(method), problem);
  state u{real(1) / 10};
  apsis::integrate(march, u, real(0), real(1), step_rule<real>::fixed(real(1) / static_cast<real>(steps)));
  return static_cast<double>(std::abs(u[0] - real(1) / 20));
}

double ode_error(const std::string& method, long steps) {
  const auto exact = reference::radau(1, 1);
  const auto u = solve(method, 1, steps, ode_model::initial_state<state>());
  return static_cast<double>(std::abs(u[0] - exact[0]) + std::abs(u[1] - exact[1]));
}

/// Observed orders of the conserved and of the relaxing component of the ODE model for ε ≪ Δt. The plateau is
/// a few tenths of ε = 1e-14, below a hundredth of every error.
struct limit_orders {
  double moment, rest;
};

limit_orders in_the_limit(const std::string& method, real initial_rest) {
  const auto exact = reference::limit(1);
  double moment[2], rest[2];
  for (int k = 0; k < 2; ++k) {
    const auto u = solve(method, 1e-14L, 64L << k, {2, initial_rest});
    moment[k] = static_cast<double>(std::abs(u[0] - exact[0]));
    rest[k] = static_cast<double>(std::abs(u[1] - exact[1]));
  }
  return {std::log2(moment[0] / moment[1]), std::log2(rest[0] / rest[1])};
}

const real consistent = std::sin(real(2)), inconsistent = 0;

/// With these steps the second error term is below a tenth of the first. This changes the slope by
/// up to 0.15.
constexpr double tolerance = 0.15;

class every_method : public ::testing::TestWithParam<std::string> {};

TEST_P(every_method, has_its_certified_order) {
  const certificate& c = apsis::find_certificate(GetParam());
  const auto error = c.kind == method_kind::implicit_only ? decay_error : ode_error;
  // If the leading error term is small, it dominates only in shorter steps. Shorter steps would make
  // errors of fourth order as small as that of the reference. The same holds for eighth order with more
  // than 48 steps.
  const long steps = c.order == 3 ? 256 : c.order < 8 ? 128 : 24;
  EXPECT_NEAR(std::log2(error(GetParam(), steps) / error(GetParam(), 2 * steps)), c.order, tolerance);
}

class every_method_with_limit : public ::testing::TestWithParam<std::string> {};

TEST_P(every_method_with_limit, has_its_certified_order_in_the_limit) {
  const certificate& c = apsis::find_certificate(GetParam());
  const auto near_equilibrium = in_the_limit(GetParam(), consistent);
  const auto far_from_it = in_the_limit(GetParam(), inconsistent);
  if (c.gsa || c.order < 5) {  // see comparators.of_fifth_order_may_lose_one_order_in_the_limit
    EXPECT_NEAR(near_equilibrium.moment, c.order, tolerance);
  }
  if (c.type == "A") {
    EXPECT_NEAR(far_from_it.moment, c.order, tolerance);
  }
  // The first step uses T(u^n) off the limit manifold.
  if (c.type == "ARS") {
    EXPECT_NEAR(far_from_it.moment, 1, tolerance);
  }
  if (c.gsa) {
    EXPECT_NEAR(near_equilibrium.rest, c.order, tolerance);
  }
  if (c.ap) {
    EXPECT_NEAR(far_from_it.rest, c.order, tolerance);
  }
}

std::vector<std::string> methods_with_limit() {
  return methods_where([](const apsis::method& m) {
    return m.kind == method_kind::imex || m.kind == method_kind::exact_collision;
  });
}

INSTANTIATE_TEST_SUITE_P(catalogue, every_method, ::testing::ValuesIn(apsis::method_names()), test_name);
INSTANTIATE_TEST_SUITE_P(catalogue, every_method_with_limit, ::testing::ValuesIn(methods_with_limit()),
                         test_name);

const auto members =
    ::testing::Values("md-imex-chain-3-2", "md-imex-chain-7-2", "md-imex-chain-20-2", "md-imex-chain-64-2",
                      "md-imex-plateau-free-6-2", "md-imex-plateau-free-20-2");
INSTANTIATE_TEST_SUITE_P(families, every_method, members, test_name);
INSTANTIATE_TEST_SUITE_P(families, every_method_with_limit, members, test_name);

// These methods are not globally stiffly accurate (docs/methods.md). u^{n+1} is not projected. Its deviation
// from equilibrium depends on the weights b A⁻¹ of the stages.
TEST(comparators, without_gsa_lose_order_outside_the_moments) {
  EXPECT_NEAR(in_the_limit("ssp2-222", inconsistent).rest, 1, tolerance);
  EXPECT_NEAR(in_the_limit("ssp3-433", inconsistent).rest, 1, tolerance);
  EXPECT_NEAR(in_the_limit("ssp2-332", inconsistent).rest, 2, tolerance);  // b is the last row of A
}

// The update u^{n+1} deviates from equilibrium by O(Δt³). T(u^{n+1}) of the next step carries this into the
// moments. In methods of lower order a larger error hides it.
TEST(comparators, of_fifth_order_may_lose_one_order_in_the_limit) {
  for (const std::string name : {"ark-548", "ark-548-2"}) {
    const auto exact = reference::limit(1);
    real moment[2], rest[2];
    for (int k = 0; k < 2; ++k) {
      const auto u = solve(name, 1e-18L, 128L << k, {2, consistent});
      moment[k] = std::abs(u[0] - exact[0]);
      rest[k] = std::abs(u[1] - exact[1]);
    }
    EXPECT_NEAR(static_cast<double>(std::log2(rest[0] / rest[1])), 3, tolerance) << name;
    if (name == "ark-548") {
      EXPECT_NEAR(static_cast<double>(std::log2(moment[0] / moment[1])), 4, tolerance);
    }
  }
}

TEST(comparators, bhr_loses_one_order_from_inconsistent_data) {
  EXPECT_NEAR(in_the_limit("bhr-553", inconsistent).moment, 2, tolerance);
  EXPECT_NEAR(in_the_limit("bhr-553", consistent).rest, 3, tolerance);
}

}  // namespace

}  // namespace method_orders_test
