// Two-step methods in integrate(): observed orders, the limit ε → 0, the error of the O(ε) terms where ε ~
// Δt, positivity, certificates and refusals.
#include <apsis/integrate/kinds/two_step.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/integrate/relaxation_problem.hpp>
#include <apsis/method/export.hpp>
#include <apsis/method/time_integrator.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <integrate/ode_model.hpp>
#include <integrate/reference.hpp>
#include <support/bad_input.hpp>

namespace two_step_test {

namespace {

using real = long double;
using state = std::vector<real>;
using testing::HasSubstr;

apsis::step_rule<real> equal(long steps) {
  return apsis::step_rule<real>::fixed(real(1) / static_cast<real>(steps));
}

const apsis::method& starter() {
  return apsis::find_method("md-imex-10-3-mixed");
}

/// Returns the rows of a two-step method as its file has them.
const apsis::method& rows_of(const std::string& name) {
  return *apsis::find_integrator(name).file();
}

/// Returns the error for Kaps' problem with ε = 1, whose solution from (1, 1) is u1 = e^{−t}, u2 = u1².
real error_of(const apsis::method& m, long steps) {
  auto problem = apsis::make_relaxation_problem<state>(
      [](real, const state& u, state& out) { out = {u[1] - u[0] - u[0] * u[0], -2 * u[1]}; },
      [](const state& u) { return u[0]; }, [](real w, state& out) { out = {w, w * w}; },
      [](real) { return real(1); }, real(1));
  apsis::two_step march(m, starter(), problem);
  state u{1, 1};
  apsis::integrate(march, u, real(0), real(1), equal(steps));
  return std::abs(u[0] - std::exp(real(-1))) + std::abs(u[1] - std::exp(real(-2)));
}

TEST(two_step, observed_order_is_the_claimed_one) {
  ASSERT_FALSE(apsis::integrator_names("two-step").empty());
  for (const auto& name : apsis::integrator_names("two-step")) {
    const auto m = rows_of(name);
    // At these steps the second error term is a tenth of the first.
    EXPECT_NEAR(static_cast<double>(std::log2(error_of(m, 256) / error_of(m, 512))), m.claims.order, 0.15)
        << name;
  }
}

TEST(two_step, has_its_order_in_the_limit_from_data_out_of_equilibrium) {
  const auto exact = reference::limit(1);
  // The steps are a list, because clang-19 -O1 converts 256L << i to a long double that is NaN.
  constexpr long steps[] = {256, 512};
  for (const auto& name : apsis::integrator_names("two-step")) {
    const auto m = rows_of(name);
    real moment[2], rest[2];
    for (int i = 0; i < 2; ++i) {
      auto problem = ode_model::as_relaxation<state>(1e-17L);
      apsis::two_step march(m, starter(), problem);
      state u{2, 0};
      apsis::integrate(march, u, real(0), real(1), equal(steps[i]));
      moment[i] = std::abs(u[0] - exact[0]);
      rest[i] = std::abs(u[1] - exact[1]);
    }
    // At these steps the second error term is a tenth of the first, and ε is below every error.
    EXPECT_NEAR(static_cast<double>(std::log2(moment[0] / moment[1])), m.claims.order, 0.2) << name;
    EXPECT_NEAR(static_cast<double>(std::log2(rest[0] / rest[1])), m.claims.order, 0.2) << name;
  }
}

// T depends on t, and every row evaluates it at its own time.
TEST(two_step, integrates_polynomials_below_its_order_exactly) {
  for (const auto& name : apsis::integrator_names("two-step")) {
    const auto m = rows_of(name);
    const auto degree = static_cast<real>(m.claims.order);
    auto problem = apsis::make_relaxation_problem<state>(
        [degree](real t, const state&, state& out) { out = {degree * std::pow(t, degree - 1), real(0)}; },
        [](const state& u) { return u[0]; }, [](real w, state& out) { out = {w, real(0)}; },
        [](real) { return real(1); }, real(1));
    apsis::two_step march(m, starter(), problem);
    state u{0, 0};
    apsis::integrate(march, u, real(0), real(1), equal(16));
    // The result is a sum of 16 steps with some 50 products below 1.
    EXPECT_LE(std::abs(u[0] - 1), 1e-17L) << name;
  }
}

/// For w' = v, v' = 1 − v/ε the deviation v = ε from equilibrium changes the moment w. Returns its rate in
/// the steady state of a run with Δt = zε, relative to the exact rate ε.
real observed_flux(const apsis::method& m, real z) {
  const real epsilon = 1 / z;
  auto problem = apsis::make_relaxation_problem<state>(
      [](real, const state& u, state& out) { out = {u[1], real(1)}; }, [](const state& u) { return u[0]; },
      [](real w, state& out) { out = {w, real(0)}; }, [](real) { return real(1); }, epsilon);
  apsis::two_step march(m, starter(), problem);
  state u{0, epsilon};
  real before = 0;
  const auto observe = [&](long step, real, real, const state& now) {
    if (step == 399) before = now[0];
    return true;
  };
  apsis::integrate(march, u, real(0), real(400), apsis::step_rule<real>::fixed(1), observe);
  return (u[0] - before) / epsilon;
}

TEST(two_step, flux_of_a_run_is_the_certified_one_at_every_z) {
  for (const auto& name : apsis::integrator_names("two-step")) {
    const auto m = rows_of(name);
    const auto form = m.coefficients<real>();
    for (const real z : {0.1L, 1.0L, 3.0L, 10.0L, 100.0L}) {
      const real flux = apsis::two_step_at_finite_rate(form, z).flux;
      // The rate is a difference of sums of 400 numbers, up to 400ε.
      EXPECT_NEAR(static_cast<double>(observed_flux(m, z) - flux), 0.0, 1e-13) << name << " " << z;
    }
    // At the maximum of the band the flux differs from 1 by the error of the band times z.
    const auto band = apsis::certify_two_step(m).band;
    EXPECT_NEAR(static_cast<double>(std::abs(observed_flux(m, static_cast<real>(band.at)) - 1)),
                band.error * band.at, 1e-3 * band.error * band.at)
        << name;
  }
}

/// Returns the smallest value of upwind differences for a step function that is in equilibrium. Forward Euler
/// steps up to Δx are nonnegative.
real smallest_value(const apsis::method& m, real step) {
  constexpr std::size_t cells = 40;
  auto problem = apsis::make_relaxation_problem<state>(
      [](real, const state& u, state& out) {
        out.resize(cells);
        for (std::size_t i = 0; i < cells; ++i) out[i] = u[(i + cells - 1) % cells] - u[i];
      },
      [](const state& u) { return u; }, [](const state& w, state& out) { out = w; },
      [](const state&) { return real(1); }, real(1));
  apsis::two_step march(m, starter(), problem);
  state u(cells);
  for (std::size_t i = 10; i < 20; ++i) u[i] = 1;
  real smallest = 1;
  // The starter takes the first two steps, at half of its r.
  const real first = real(0.5) * march.starter().r();
  state before = u;
  march.starter().step(0, first, u);
  march.starter().step(0, first, u);
  before = u;
  march.starter().step(0, std::min(step, first), u);
  march.restart();
  march.add(0, step, before);
  for (int n = 0; n < 5; ++n) {
    march.step(0, step, u);
    smallest = std::min(smallest, *std::min_element(u.begin(), u.end()));
  }
  return smallest;
}

TEST(two_step, is_positive_up_to_r_and_not_far_above) {
  for (const auto& name : apsis::integrator_names("two-step")) {
    const auto m = rows_of(name);
    const real r = m.coefficients<real>().r;
    EXPECT_GE(smallest_value(m, r), 0) << name;
    // The r of the form is only a lower bound of the largest step.
    EXPECT_LT(smallest_value(m, 6 * r), 0) << name;
  }
}

TEST(two_step, failed_step_changes_nothing) {
  const auto m = rows_of(apsis::integrator_names("two-step").front());
  int calls = 0, fails_at = -1;
  auto problem = apsis::make_relaxation_problem<state>(
      [&](real, const state& u, state& out) {
        if (++calls == fails_at) throw apsis::numerical_error("no transport");
        out = {u[1], -u[0]};
      },
      [](const state& u) { return u[0]; }, [](real w, state& out) { out = {w, std::sin(w)}; },
      [](real) { return real(0.1L); }, real(1));
  apsis::two_step march(m, starter(), problem);
  const state first{1, 0};
  state u{0.9L, 0.1L};
  march.add(0, 0.1L, first);
  state expected = u;
  march.step(0, 0.1L, expected);
  march.restart();
  march.add(0, 0.1L, first);
  calls = 0;
  fails_at = 3;
  state tried = u;
  EXPECT_THROW(march.step(0, 0.1L, tried), apsis::numerical_error);
  EXPECT_EQ(tried, u);
  fails_at = -1;
  march.step(0, 0.1L, tried);
  EXPECT_EQ(tried, expected);
}

TEST(two_step, step_evaluates_the_transport_as_often_as_certified) {
  for (const auto& name : apsis::integrator_names("two-step")) {
    const auto m = rows_of(name);
    int evaluations = 0;
    auto problem = apsis::make_relaxation_problem<state>(
        [&](real, const state& u, state& out) {
          ++evaluations;
          out = {u[1], -u[0]};
        },
        [](const state& u) { return u[0]; }, [](real w, state& out) { out = {w, std::sin(w)}; },
        [](real) { return real(1); }, real(1));
    apsis::two_step march(m, starter(), problem);
    state u{1, 0};
    march.add(0, 0.1L, u);
    march.step(0, 0.1L, u);
    EXPECT_EQ(evaluations, apsis::certify_two_step(m).explicit_evaluations) << name;
  }
}

TEST(two_step, is_refused_with_a_tolerance) {
  const auto m = rows_of(apsis::integrator_names("two-step").front());
  auto problem = ode_model::as_relaxation<state>(1e-2L);
  apsis::two_step march(m, starter(), problem);
  state u{2, 0};
  bad_input::expect_refused({
      {[&] { apsis::integrate(march, u, real(0), real(1), apsis::step_rule<real>::ssp()); },
       {"needs equal steps"}},
  });
}

TEST(two_step, certificate_names_a_claim_that_does_not_hold) {
  auto m = rows_of(apsis::integrator_names("two-step").front());
  EXPECT_TRUE(apsis::certify_two_step(m).claims_hold());
  EXPECT_EQ(apsis::to_toml(apsis::parse_any_method(apsis::to_toml(m), "m.toml")), apsis::to_toml(m));
  auto wrong = m;
  ++wrong.claims.order;
  EXPECT_THAT(apsis::certify_two_step(wrong).failures, testing::ElementsAre(HasSubstr("the order is 3")));
  wrong = m;
  wrong.exact.D(1, 1) = "-0.1";
  EXPECT_THAT(apsis::certify_two_step(wrong).failures.front(), HasSubstr("d_2 = -0.1 is negative"));
}

}  // namespace

}  // namespace two_step_test
