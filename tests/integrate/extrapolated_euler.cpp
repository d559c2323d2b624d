// Extrapolated implicit–explicit Euler steps (family extrapolated-euler-S) in the stepper: closed forms of
// steps for linear T and Q, observed orders, and the embedded solution as an error estimate.
#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/integrate.hpp>
#include <apsis/integrate/relaxation_problem.hpp>
#include <apsis/method/certificate.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <integrate/ode_model.hpp>
#include <integrate/reference.hpp>

namespace extrapolated_euler_test {

namespace {

using real = long double;
using state = std::vector<real>;

const apsis::method& columns(int s) {
  return apsis::find_method("extrapolated-euler-" + std::to_string(s));
}

/// Returns the weight of n substeps, (−1)^{s−n} n^s/(n! (s−n)!).
real weight(int n, int s) {
  return std::pow(real(n), real(s)) / (std::tgamma(real(n + 1)) * std::tgamma(real(s - n + 1))) *
         ((s - n) % 2 == 0 ? 1 : -1);
}

/// Returns the result of one step of length 1 for u1' = λ u1, u2' = −u2/ε.
state one_step(int s, real lambda, real epsilon) {
  auto problem = apsis::make_relaxation_problem<state>(
      [lambda](real, const state& u, state& out) { out = {lambda * u[0], real(0)}; },
      [](const state& u) { return u[0]; }, [](real w, state& out) { out = {w, real(0)}; },
      [](real) { return real(1); }, epsilon);
  apsis::stepper march(columns(s), problem);
  state u{1, 1};
  march.step(real(0), real(1), u);
  return u;
}

TEST(extrapolated_euler, steps_of_linear_problems_have_closed_forms) {
  for (int s = 2; s <= 8; ++s)
    for (const real z : {0.01L, 0.5L, 2.0L, 30.0L, 1e6L}) {
      real transport(0), collision(0), size(0), factor(0);
      for (int n = 1; n <= s; ++n) {
        const real grown = std::pow(1 - z / real(n), real(n));
        transport += weight(n, s) * grown;
        collision += weight(n, s) * std::pow(1 + z / real(n), real(-n));
        size += std::abs(weight(n, s) * grown);
        factor += std::abs(weight(n, s));
      }
      const auto u = one_step(s, -z, 1 / z);
      // The tolerance covers the rounding of the coefficients and of up to 36 substeps, amplified
      // by the weights.
      const real rounding = 100 * std::numeric_limits<real>::epsilon();
      EXPECT_LE(std::abs(u[0] - transport), rounding * size) << s << " " << z;
      EXPECT_LE(std::abs(u[1] - collision), rounding * factor) << s << " " << z;
    }
}

/// Returns the error for Kaps' problem with ε = 1, whose solution from (1, 1) is u1 = e^{−t}, u2 = u1².
real error_of(int s, long steps) {
  auto problem = apsis::make_relaxation_problem<state>(
      [](real, const state& u, state& out) { out = {u[1] - u[0] - u[0] * u[0], -2 * u[1]}; },
      [](const state& u) { return u[0]; }, [](real w, state& out) { out = {w, w * w}; },
      [](real) { return real(1); }, real(1));
  apsis::stepper march(columns(s), problem);
  state u{1, 1};
  apsis::integrate(march, u, real(0), real(1),
                   apsis::step_rule<real>::fixed(real(1) / static_cast<real>(steps)));
  return std::abs(u[0] - std::exp(real(-1))) + std::abs(u[1] - std::exp(real(-2)));
}

TEST(extrapolated_euler, has_the_observed_order_of_its_certificate) {
  for (int s = 2; s <= 7; ++s) {
    const auto& c = apsis::find_certificate("extrapolated-euler-" + std::to_string(s));
    EXPECT_EQ(c.order, s);
    ASSERT_TRUE(c.embedded);
    EXPECT_EQ(c.embedded->order, s - 1);
    EXPECT_EQ(c.explicit_evaluations, 1 + s * (s - 1) / 2);
    EXPECT_EQ(c.implicit_solves, s * (s + 1) / 2);
    EXPECT_EQ(c.type, "ARS");
    EXPECT_EQ(c.ssp_coefficient, 0);
    // At these steps the second error term is a tenth of the first, and rounding errors are a thousandth.
    const long steps = s < 6 ? 32 : 16;
    EXPECT_NEAR(static_cast<double>(std::log2(error_of(s, steps) / error_of(s, 2 * steps))), s, 0.15) << s;
  }
}

// T(u^n) of the first substep is evaluated off equilibrium. Its error is proportional to Δt/n, the
// first of the terms that extrapolation removes. Unlike other methods of type ARS, these need no
// resolved initial layer.
TEST(extrapolated_euler, has_its_order_in_the_limit_from_data_out_of_equilibrium) {
  const auto exact = reference::limit(1);
  for (int s = 2; s <= 6; ++s) {
    real moment[2], rest[2];
    for (int k = 0; k < 2; ++k) {
      auto problem = ode_model::as_relaxation<state>(1e-17L);
      apsis::stepper march(columns(s), problem);
      state u{2, 0};
      const long steps = (s < 6 ? 64L : 16L) << k;
      apsis::integrate(march, u, real(0), real(1),
                       apsis::step_rule<real>::fixed(real(1) / static_cast<real>(steps)));
      moment[k] = std::abs(u[0] - exact[0]);
      rest[k] = std::abs(u[1] - exact[1]);
    }
    // At these steps the second error term is a tenth of the first, and ε is below every error.
    EXPECT_NEAR(static_cast<double>(std::log2(moment[0] / moment[1])), s, 0.2) << s;
    EXPECT_NEAR(static_cast<double>(std::log2(rest[0] / rest[1])), s, 0.2) << s;
  }
}

TEST(extrapolated_euler, ninth_column_is_refused_with_the_range) {
  try {
    columns(9);
    FAIL() << "no error";
  } catch (const apsis::input_error& error) {
    EXPECT_NE(std::string(error.what()).find("extrapolated-euler-S has S from 2 to 8"), std::string::npos)
        << error.what();
  }
}

TEST(extrapolated_euler, steps_to_a_tolerance_reach_it_where_layers_are_resolved) {
  for (const double epsilon : {1.0, 1e-2, 1e-4})
    for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
      auto problem = ode_model::as_relaxation<std::vector<double>>(epsilon);
      apsis::stepper march(columns(6), problem, apsis::solutions::result_and_embedded);
      apsis::step_controller<double> control(tolerance, 5);
      auto u = ode_model::initial_state<std::vector<double>>();
      apsis::integrate_to_tolerance(march, u, 0.0, 1.0, apsis::step_rule<double>::unlimited(), control,
                                    [](const auto& a, const auto& b) {
                                      return std::hypot(a[0] - b[0], a[1] - b[1]) / std::hypot(a[0], a[1]);
                                    });
      const auto exact = reference::radau(epsilon, 1);
      // There are a handful of steps, each with an estimate below the tolerance. The problem is contracting.
      EXPECT_LT(
          std::abs(u[0] - static_cast<double>(exact[0])) + std::abs(u[1] - static_cast<double>(exact[1])),
          30 * tolerance)
          << epsilon << " " << tolerance;
    }
}

}  // namespace

}  // namespace extrapolated_euler_test
