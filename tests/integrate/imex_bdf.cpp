// IMEX-BDF in integrate(): coefficients, observed orders, the limit ε → 0 and refusals.
#include <apsis/integrate/kinds/imex_bdf.hpp>

#include <apsis/integrate/relaxation_problem.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <integrate/ode_model.hpp>
#include <integrate/reference.hpp>

namespace imex_bdf_test {

namespace {

using real = long double;
using state = std::vector<real>;

apsis::step_rule<real> equal(long steps) {
  return apsis::step_rule<real>::fixed(real(1) / static_cast<real>(steps));
}

/// Returns u(1) of the ODE model.
state solve_ode_model(int k, real epsilon, apsis::step_rule<real> rule) {
  auto problem = ode_model::as_relaxation<state>(epsilon);
  apsis::imex_bdf march(k, problem);
  state u{2, 0};
  apsis::integrate(march, u, real(0), real(1), rule);
  return u;
}

TEST(imex_bdf, coefficients_are_the_published_ones) {
  // The numerators and the denominator are those of BDF (Hairer, Wanner, section V.1). The weights of T are
  // b_k times binomial coefficients.
  const std::vector<std::vector<real>> a = {
      {1}, {4, -1}, {18, -9, 2}, {48, -36, 16, -3}, {300, -300, 200, -75, 12}};
  const std::vector<std::vector<real>> c = {
      {1}, {4, -2}, {18, -18, 6}, {48, -72, 48, -12}, {300, -600, 600, -300, 60}};
  const std::vector<real> b = {1, 2, 6, 12, 60}, denominator = {1, 3, 11, 25, 137};
  for (int k = 1; k <= 5; ++k) {
    const auto m = apsis::imex_bdf_coefficients<real>(k);
    const auto at = static_cast<std::size_t>(k - 1);
    ASSERT_EQ(m.steps(), k);
    // The tolerance covers a handful of roundings.
    const real rounding = 20 * std::numeric_limits<real>::epsilon();
    EXPECT_NEAR(static_cast<double>(m.b * denominator[at] / b[at] - 1), 0, static_cast<double>(rounding));
    for (std::size_t i = 0; i <= at; ++i) {
      EXPECT_LE(std::abs(m.a[i] * denominator[at] - a[at][i]), rounding * std::abs(a[at][i]))
          << k << " " << i;
      EXPECT_LE(std::abs(m.c[i] * denominator[at] - c[at][i]), rounding * std::abs(c[at][i]))
          << k << " " << i;
    }
  }
}

/// Returns the error for Kaps' problem with ε = 1, whose solution from (1, 1) is u1 = e^{−t}, u2 = u1².
real error_of(int k, long steps) {
  auto problem = apsis::make_relaxation_problem<state>(
      [](real, const state& u, state& out) { out = {u[1] - u[0] - u[0] * u[0], -2 * u[1]}; },
      [](const state& u) { return u[0]; }, [](real w, state& out) { out = {w, w * w}; },
      [](real) { return real(1); }, real(1));
  apsis::imex_bdf march(k, problem);
  state u{1, 1};
  apsis::integrate(march, u, real(0), real(1), equal(steps));
  return std::abs(u[0] - std::exp(real(-1))) + std::abs(u[1] - std::exp(real(-2)));
}

TEST(imex_bdf, observed_order_is_the_number_of_steps) {
  // At these steps the second error term is a tenth of the first.
  for (int k = 1; k <= 5; ++k)
    EXPECT_NEAR(static_cast<double>(std::log2(error_of(k, 128) / error_of(k, 256))), k, 0.15) << k;
}

// The formula does not use T(u⁰) off equilibrium. Extrapolation removes the effect of T(u⁰) on
// the first steps.
TEST(imex_bdf, has_its_order_in_the_limit_from_data_out_of_equilibrium) {
  const auto exact = reference::limit(1);
  // The steps are a list, because clang-19 -O1 converts 128L << i to a long double that is NaN.
  constexpr long steps[] = {128, 256};
  for (int k = 2; k <= 5; ++k) {
    real moment[2], rest[2];
    for (int i = 0; i < 2; ++i) {
      const auto u = solve_ode_model(k, 1e-17L, equal(steps[i]));
      moment[i] = std::abs(u[0] - exact[0]);
      rest[i] = std::abs(u[1] - exact[1]);
    }
    // At these steps the second error term is a tenth of the first, and ε is below every error.
    EXPECT_NEAR(static_cast<double>(std::log2(moment[0] / moment[1])), k, 0.2) << k;
    EXPECT_NEAR(static_cast<double>(std::log2(rest[0] / rest[1])), k, 0.2) << k;
  }
}

// The values in the first formula are one full step apart, whatever steps replace the first one.
TEST(imex_bdf, graded_start_resolves_a_layer_within_the_first_step) {
  for (const real epsilon : {1e-4L, 1e-5L, 1e-6L})
    for (int k = 2; k <= 4; ++k) {
      const auto exact = reference::radau(epsilon, 1);
      const auto u = solve_ode_model(k, epsilon, equal(512).with(apsis::startup::graded));
      // The bound is forty times Δt^k plus a thousandth of the effect ε of an unresolved layer. A value at a
      // wrong time would give an error of Δt.
      const real bound = 40 * std::pow(1 / 512.0L, static_cast<real>(k)) + 1e-3L * epsilon;
      EXPECT_LT(std::abs(u[0] - exact[0]) + std::abs(u[1] - exact[1]), bound) << epsilon << " " << k;
    }
}

TEST(imex_bdf, integrates_polynomials_of_its_degree_exactly) {
  for (int k = 1; k <= 5; ++k) {
    auto problem = apsis::make_relaxation_problem<state>(
        [k](real t, const state&, state& out) { out = {real(k) * std::pow(t, real(k - 1)), real(0)}; },
        [](const state& u) { return u[0]; }, [](real w, state& out) { out = {w, real(0)}; },
        [](real) { return real(1); }, real(1));
    apsis::imex_bdf march(k, problem);
    state u{0, 0};
    apsis::integrate(march, u, real(0), real(1), equal(16));
    if (k == 1) {
      // The explicit rule of order 1 is exact for a constant T.
      EXPECT_LE(std::abs(u[0] - 1), 1e-17L);
    } else {
      // The result is a sum of a hundred numbers up to 1. Coefficients up to 5 and start values with weights
      // up to 300 amplify its rounding errors.
      EXPECT_LE(std::abs(u[0] - 1), 1e-15L) << k;
    }
  }
}

TEST(imex_bdf, step_evaluates_the_transport_once) {
  long evaluations = 0;
  auto problem = apsis::make_relaxation_problem<state>(
      [&](real, const state& u, state& out) {
        ++evaluations;
        out = {u[1], real(0)};
      },
      [](const state& u) { return u[0]; }, [](real w, state& out) { out = {w, std::sin(w)}; },
      [](real) { return real(1); }, real(1));
  apsis::imex_bdf march(3, problem);
  long counts[2];
  for (int i = 0; i < 2; ++i) {
    evaluations = 0;
    state u{2, 0};
    apsis::integrate(march, u, real(0), real(1), equal(20 + i));
    counts[i] = evaluations;
  }
  EXPECT_EQ(counts[1] - counts[0], 1);
}

TEST(imex_bdf, history_is_discarded_between_integrations) {
  auto problem = ode_model::as_relaxation<state>(1e-3L);
  apsis::imex_bdf march(4, problem);
  state first{2, 0}, second{2, 0}, other{1, 1};
  apsis::integrate(march, first, real(0), real(1), equal(20));
  apsis::integrate(march, other, real(0), real(1), equal(7));
  apsis::integrate(march, second, real(0), real(1), equal(20));
  EXPECT_EQ(first, second);
}

template <class Body>
std::string message_of(const Body& body) {
  try {
    body();
  } catch (const apsis::input_error& error) {
    return error.what();
  }
  return "no error";
}

TEST(imex_bdf, orders_outside_1_to_5_and_rules_without_dt_are_refused) {
  auto problem = ode_model::as_relaxation<state>(1e-3L);
  for (const int k : {0, 6})
    EXPECT_EQ(message_of([&] { apsis::imex_bdf march(k, problem); }),
              "there is no IMEX-BDF method of order " + std::to_string(k) +
                  " here (its orders are 1 to 5); choose one of these");
  apsis::imex_bdf march(2, problem);
  state u{2, 0};
  EXPECT_EQ(message_of([&] { apsis::integrate(march, u, real(0), real(1), apsis::step_rule<real>::ssp()); }),
            "IMEX-BDF needs equal steps (its coefficients depend on earlier steps); give dt");
}

}  // namespace

}  // namespace imex_bdf_test
