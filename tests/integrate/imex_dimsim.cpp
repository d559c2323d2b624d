// IMEX-DIMSIM in integrate(): observed orders for every ε, evaluations, history and refusals.
#include <apsis/integrate/kinds/imex_dimsim.hpp>

#include <apsis/integrate/relaxation_problem.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <integrate/ode_model.hpp>
#include <integrate/reference.hpp>
#include <support/bad_input.hpp>

namespace imex_dimsim_test {

namespace {

using real = long double;
using state = std::vector<real>;

apsis::step_rule<real> equal(long steps) {
  return apsis::step_rule<real>::fixed(real(1) / static_cast<real>(steps));
}

constexpr real all_epsilon[] = {1.0L, 0.1L, 1e-2L, 1e-3L, 1e-4L, 1e-6L, 1e-12L};

/// Kaps' problem. Its solution from (1, 1) is u1 = e^{−t}, u2 = u1² for every ε.
auto kaps(real epsilon) {
  return apsis::make_relaxation_problem<state>(
      [](real, const state& u, state& out) { out = {u[1] - u[0] - u[0] * u[0], -2 * u[1]}; },
      [](const state& u) { return u[0]; }, [](real w, state& out) { out = {w, w * w}; },
      [](real) { return real(1); }, epsilon);
}

state solution_of_kaps(real t) {
  return {std::exp(-t), std::exp(-2 * t)};
}

real error_at_end(const state& u) {
  const state exact = solution_of_kaps(1);
  return std::abs(u[0] - exact[0]) + std::abs(u[1] - exact[1]);
}

/// Returns the error of steps that follow exact values at the times 0, Δt, …, pΔt.
real error_after_exact_values(int p, real epsilon, long steps) {
  auto problem = kaps(epsilon);
  apsis::imex_dimsim march(p, problem);
  const real dt = real(1) / static_cast<real>(steps);
  const auto time = [dt](long n) { return static_cast<real>(n) * dt; };
  for (long n = 0; n < p; ++n) march.add(time(n), dt, solution_of_kaps(time(n)));
  state u = solution_of_kaps(time(p));
  for (long n = p; n < steps; ++n) march.step(time(n), dt, u);
  return error_at_end(u);
}

// The stage order is the order, so that no ε reduces it.
TEST(imex_dimsim, observed_order_is_the_claimed_one_for_every_epsilon) {
  for (const int p : {2, 3})
    for (const real epsilon : all_epsilon) {
      const real coarse = error_after_exact_values(p, epsilon, 256),
                 fine = error_after_exact_values(p, epsilon, 512);
      // At these steps the next error term is at most a tenth of the first.
      EXPECT_NEAR(static_cast<double>(std::log2(coarse / fine)), p, 0.2) << p << " " << epsilon;
    }
}

// Where ε ~ Δt, the order of the starter is reduced to 2. With p = 3 its first steps then cause most of the
// error, which reaches 0.04 Δt³.
TEST(imex_dimsim, starter_adds_an_error_of_the_order_of_the_formula) {
  for (const int p : {2, 3})
    for (const real epsilon : all_epsilon) {
      auto problem = kaps(epsilon);
      apsis::imex_dimsim march(p, problem);
      state u{1, 1};
      apsis::integrate(march, u, real(0), real(1), equal(512));
      EXPECT_LT(error_at_end(u), 0.1L * std::pow(1 / 512.0L, static_cast<real>(p))) << p << " " << epsilon;
    }
}

TEST(imex_dimsim, has_its_order_in_the_limit_from_data_out_of_equilibrium) {
  const auto exact = reference::limit(1);
  for (const int p : {2, 3}) {
    real error[2];
    for (int i = 0; i < 2; ++i) {
      auto problem = ode_model::as_relaxation<state>(1e-17L);
      apsis::imex_dimsim march(p, problem);
      state u{2, 0};
      apsis::integrate(march, u, real(0), real(1), equal(i == 0 ? 256 : 512));
      error[i] = std::abs(u[0] - exact[0]) + std::abs(u[1] - exact[1]);
    }
    // At these steps the second error term is a tenth of the first, and ε is below every error.
    EXPECT_NEAR(static_cast<double>(std::log2(error[0] / error[1])), p, 0.2) << p;
  }
}

TEST(imex_dimsim, integrates_polynomials_of_its_degree_exactly) {
  for (const int p : {2, 3}) {
    auto problem = apsis::make_relaxation_problem<state>(
        [p](real t, const state&, state& out) { out = {real(p) * std::pow(t, real(p - 1)), real(0)}; },
        [](const state& u) { return u[0]; }, [](real w, state& out) { out = {w, real(0)}; },
        [](real) { return real(1); }, real(1));
    apsis::imex_dimsim march(p, problem);
    state u{0, 0};
    apsis::integrate(march, u, real(0), real(1), equal(16));
    // The result is a sum of a hundred numbers up to 1 with coefficients up to 5.
    EXPECT_LE(std::abs(u[0] - 1), 1e-16L) << p;
  }
}

TEST(imex_dimsim, step_evaluates_the_transport_once_for_each_stage) {
  for (const int p : {2, 3}) {
    long evaluations = 0;
    auto problem = apsis::make_relaxation_problem<state>(
        [&](real, const state& u, state& out) {
          ++evaluations;
          out = {u[1], real(0)};
        },
        [](const state& u) { return u[0]; }, [](real w, state& out) { out = {w, std::sin(w)}; },
        [](real) { return real(1); }, real(1));
    apsis::imex_dimsim march(p, problem);
    long counts[2];
    for (int i = 0; i < 2; ++i) {
      evaluations = 0;
      state u{2, 0};
      apsis::integrate(march, u, real(0), real(1), equal(20 + i));
      counts[i] = evaluations;
    }
    EXPECT_EQ(counts[1] - counts[0], p);
  }
}

TEST(imex_dimsim, history_is_discarded_between_integrations) {
  auto problem = ode_model::as_relaxation<state>(1e-3L);
  apsis::imex_dimsim march(3, problem);
  state first{2, 0}, second{2, 0}, other{1, 1};
  apsis::integrate(march, first, real(0), real(1), equal(20));
  apsis::integrate(march, other, real(0), real(1), equal(7));
  apsis::integrate(march, second, real(0), real(1), equal(20));
  EXPECT_EQ(first, second);
}

TEST(imex_dimsim, other_orders_and_rules_without_dt_are_refused) {
  auto problem = ode_model::as_relaxation<state>(1e-3L);
  apsis::imex_dimsim march(2, problem);
  state u{2, 0};
  bad_input::expect_refused({
      {[&] { apsis::imex_dimsim other(1, problem); },
       {"there is no IMEX-DIMSIM of order 1 (its orders are 2 and 3); choose one of these"}},
      {[&] { apsis::imex_dimsim other(4, problem); }, {"there is no IMEX-DIMSIM of order 4"}},
      {[&] { apsis::integrate(march, u, real(0), real(1), apsis::step_rule<real>::ssp()); },
       {"IMEX-DIMSIM needs equal steps (its coefficients depend on earlier steps); give dt"}},
  });
}

}  // namespace

}  // namespace imex_dimsim_test
