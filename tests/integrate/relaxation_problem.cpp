// Closed-form stages of relaxation problems: weights, Properties 3–5 of the paper (C14), positivity of
// backward Euler (C15), and ε = 0.
#include <apsis/integrate/relaxation_problem.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/relaxation_weights.hpp>
#include <apsis/integrate/autodiff.hpp>
#include <apsis/integrate/exact_collisions.hpp>
#include <apsis/integrate/integrate.hpp>
#include <apsis/integrate/newton_problem.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <integrate/ode_model.hpp>
#include <integrate/random.hpp>
#include <support/property.hpp>

namespace relaxation_problem_test {

namespace {

using random_input::magnitude;
using random_input::nonnegative;
using random_input::one_in;
using random_input::uniform;
using row = std::vector<double>;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double rounding = std::numeric_limits<double>::epsilon();

/// The collision operator of the Broadwell model in kinetic form, f = (f+, f0, f-), without E and C.
constexpr auto broadwell_collision = [](const auto& f, auto& out) {
  const auto gain = f[1] * f[1] - f[0] * f[2];
  out[0] = gain;
  out[1] = -gain;
  out[2] = gain;
};

struct broadwell_moments {
  double rho, m;
};

/// The Broadwell model as relaxation: C = ρ, E = ((ρ+m)², ρ²−m², (ρ−m)²)/(4ρ) (paper, C16). A vacuum is its
/// own equilibrium.
auto broadwell(double epsilon) {
  return apsis::relaxation_problem(
      apsis::no_transport{},
      [](const row& f) { return broadwell_moments{f[0] + 2 * f[1] + f[2], f[0] - f[2]}; },
      [](broadwell_moments w, row& out) {
        const double quarter = w.rho > 0 ? 1 / (4 * w.rho) : 0;
        out[0] = (w.rho + w.m) * (w.rho + w.m) * quarter;
        out[1] = (w.rho + w.m) * (w.rho - w.m) * quarter;
        out[2] = (w.rho - w.m) * (w.rho - w.m) * quarter;
      },
      [](broadwell_moments w) { return w.rho; }, epsilon);
}

TEST(relaxation_weights, are_accurate_to_a_few_ulps_and_sum_to_one) {
  check_property("weights", [] {
    const double a = one_in(3) ? 0.0 : magnitude(-12, 12);
    const double b = one_in(3) ? 0.0 : -magnitude(-20, 20);
    const double rate = magnitude(-6, 6), epsilon = magnitude(-12, 6);
    const auto w = apsis::relax_weights(a, b, rate, epsilon);
    const long double k = static_cast<long double>(rate) / epsilon, mu = a * k - b * k * k;
    const long double of_u = 1 / (1 + mu), of_e = mu / (1 + mu);
    // The smaller weight results from five roundings.
    RC_ASSERT(std::abs(w.of_u - of_u) <= 5 * rounding * of_u);
    RC_ASSERT(std::abs(w.of_e - of_e) <= 5 * rounding * of_e);
    RC_ASSERT(w.of_u + w.of_e == 1.0);
  });
}

TEST(relaxation_weights, limits_are_exact) {
  const auto is = [](apsis::relaxation_weights<double> w, double of_u, double of_e) {
    EXPECT_EQ(w.of_u, of_u);
    EXPECT_EQ(w.of_e, of_e);
  };
  is(apsis::relax_weights(0.0, 0.0, 1.0, 1.0), 1, 0);
  is(apsis::relax_weights(0.0, 0.0, 1.0, 0.0), 1, 0);
  is(apsis::relax_weights(0.1, 0.0, 1.0, 0.0), 0, 1);
  is(apsis::relax_weights(0.0, -0.1, 1.0, 0.0), 0, 1);
  is(apsis::relax_weights(1.0, -1.0, 1.0, 1e-200), 0, 1);
  is(apsis::relax_weights(1.0, -1.0, 0.0, 0.0), 1, 0);
  EXPECT_TRUE(std::isnan(apsis::relax_weights(1.0, 0.0, std::nan(""), 1.0).of_u));
  EXPECT_TRUE(std::isnan(apsis::relax_weights(1.0, 0.0, 1.0, std::nan("")).of_e));
}

TEST(claims, C14_broadwell_is_a_relaxation_with_rate_rho) {
  check_property("Q, RQ = 0, Q(E) = 0", [] {
    auto problem = broadwell(1.0);
    const row f = nonnegative(3);
    RC_PRE(f[0] + f[1] + f[2] > 0);
    row q(3), expected(3);
    const apsis::target<row, double> to{&q, 0.0, 1.0, true};
    problem.add_collision(0, f, {&to, 1});
    broadwell_collision(f, expected);
    const double rho = f[0] + 2 * f[1] + f[2];
    // In C(E − f) terms of size ρ² cancel.
    const double tolerance = 16 * rounding * rho * rho;
    for (std::size_t k = 0; k < 3; ++k) RC_ASSERT(std::abs(q[k] - expected[k]) <= tolerance);
    RC_ASSERT(std::abs(q[0] + 2 * q[1] + q[2]) <= tolerance);
    RC_ASSERT(std::abs(q[0] - q[2]) <= tolerance);
    row e = f;
    problem.solve_collision(0, 1.0, 0.0, e);  // any nonnegative state
    auto limit = broadwell(0.0);
    limit.solve_collision(0, 1.0, 0.0, e);
    problem.add_collision(0, e, {&to, 1});
    for (std::size_t k = 0; k < 3; ++k) RC_ASSERT(std::abs(q[k]) <= tolerance);
  });
}

/// Returns the largest deviation from Q'(u)Q(u) = −C Q(u), relative to the largest |C Q_k|.
template <class Q>
double property_5_defect(const Q& collision, double rate, const row& u) {
  apsis::vector_field<double, Q> field(collision);
  row q(u.size()), q_dot(u.size());
  field.time_derivatives(u, q, q_dot);
  double worst = 0, scale = 0;
  for (std::size_t k = 0; k < u.size(); ++k) {
    worst = std::max(worst, std::abs(q_dot[k] + rate * q[k]));
    scale = std::max(scale, std::abs(rate * q[k]));
  }
  return worst / scale;
}

TEST(claims, C14_property_5_for_the_ode_model_by_automatic_differentiation) {
  check_property("ODE model", [] {
    const row u{uniform(-4, 4), uniform(-4, 4)};
    RC_PRE(std::abs(std::sin(u[0]) - u[1]) > 1e-3);
    RC_ASSERT(property_5_defect(ode_model::collision(1.0), 1 + u[0] * u[0], u) <= 8 * rounding);
  });
}

TEST(claims, C14_property_5_for_broadwell_by_automatic_differentiation) {
  check_property("Broadwell", [] {
    const row f{uniform(0, 2), uniform(0, 2), uniform(0, 2)};
    const double q = f[1] * f[1] - f[0] * f[2];
    RC_PRE(std::abs(q) > 1e-3);
    // Q̇ is a sum of three terms. By the line above each is at most 4e3 times as large as |Q|.
    RC_ASSERT(property_5_defect(broadwell_collision, f[0] + 2 * f[1] + f[2], f) <= 3 * 4e3 * rounding);
  });
}

TEST(claims, C14_property_5_for_the_relaxation_system_by_automatic_differentiation) {
  const auto collision = [](const auto& u, auto& out) {
    using std::exp;
    out[0] = 0 * u[0];
    out[1] = exp(-u[0] * u[0]) + u[0] * u[0] / 2 - u[1];  // F(u1) − u2 for some smooth F
  };
  check_property("relaxation system", [&] {
    const row u{uniform(-2, 2), uniform(3, 5)};
    RC_ASSERT(property_5_defect(collision, 1.0, u) <= 8 * rounding);
  });
}

TEST(claims, C14_property_5_for_bgk_by_automatic_differentiation) {
  constexpr int n = 128;
  constexpr double v_max = 20, dv = 2 * v_max / n;
  const auto velocity = [](int k) { return -v_max + (k + 0.5) * dv; };
  const auto collision = [&](const auto& f, auto& out) {
    using std::exp, std::sqrt;
    auto rho = 0 * f[0], momentum = 0 * f[0], energy = 0 * f[0];
    for (std::size_t k = 0; k < n; ++k) {
      const double v = velocity(static_cast<int>(k));
      rho += f[k] * dv;
      momentum += f[k] * (v * dv);
      energy += f[k] * (v * v * dv);
    }
    const auto u = momentum / rho, temperature = energy / rho - u * u;
    for (std::size_t k = 0; k < n; ++k) {
      const auto c = velocity(static_cast<int>(k)) - u;
      out[k] = rho * (rho / sqrt(2 * M_PI * temperature) * exp(-c * c / (2 * temperature)) - f[k]);
    }
  };
  for (const double shift : {0.0, 0.7, 2.0}) {
    row f(n);
    for (int k = 0; k < n; ++k) {
      const double v = velocity(k);
      f[static_cast<std::size_t>(k)] =
          0.4 * std::exp(-(v - shift) * (v - shift) / 2) + 0.2 * std::exp(-(v + 1) * (v + 1));
    }
    const double rho = std::accumulate(f.begin(), f.end(), 0.0) * dv;
    // The midpoint rule reproduces the moments of these Maxwellians to about 1e-13. This is the relative size
    // of E' Q.
    EXPECT_LT(property_5_defect(collision, rho, f), 1e-11) << shift;
  }
}

TEST(claims, C15_backward_euler_is_positive_for_every_step_including_zero_data) {
  check_property("Broadwell, λ from 1e-12 to 1e12", [] {
    const double lambda = magnitude(-12, 12);
    const row f = nonnegative(3);
    row v = f;
    broadwell(1.0).solve_collision(0, lambda, 0.0, v);
    const double rho = f[0] + 2 * f[1] + f[2];
    for (const double x : v) RC_ASSERT(x >= 0.0);
    // v − f = λ Q(v) holds in extended precision, up to the rounding of terms of size ρ and λρ².
    const long double gain = static_cast<long double>(v[1]) * v[1] - static_cast<long double>(v[0]) * v[2];
    const std::array<long double, 3> sign{1, -1, 1};
    for (std::size_t k = 0; k < 3; ++k)
      RC_ASSERT(std::abs(v[k] - f[k] - lambda * sign[k] * gain) <=
                16 * static_cast<long double>(rounding) * rho * (1 + lambda * rho));
    RC_ASSERT(std::abs(v[0] + 2 * v[1] + v[2] - rho) <= 8 * rounding * rho);
    RC_ASSERT(std::abs((v[0] - v[2]) - (f[0] - f[2])) <= 8 * rounding * rho);
  });
}

TEST(claims, C15_stages_with_two_derivatives_are_positive_too) {
  check_property("any a ≥ 0, b ≤ 0, ε ≥ 0", [] {
    row v = nonnegative(3);
    const double epsilon = one_in(5) ? 0.0 : magnitude(-300, 3);
    broadwell(epsilon).solve_collision(0, magnitude(-12, 12), -magnitude(-12, 12), v);
    for (const double x : v) RC_ASSERT(x >= 0.0 && std::isfinite(x));
  });
}

TEST(relaxation_problem, closed_form_agrees_with_newton) {
  check_property("ODE model, any stage", [] {
    const double epsilon = magnitude(-10, 1);
    const double a = one_in(3) ? 0.0 : magnitude(-4, 0);
    const double b = one_in(3) ? 0.0 : -magnitude(-8, 0);
    const row u{uniform(-3, 3), uniform(-3, 3)};
    row closed = u, solved = u;
    ode_model::as_relaxation(epsilon).solve_collision(0, a, b, closed);
    ode_model::as_newton(epsilon).solve_collision(0, a, b, solved);
    // In the last Newton iterate terms cancel that are up to 1e4 times as large as the result, relative to
    // the stiff term.
    for (std::size_t k = 0; k < 2; ++k) RC_ASSERT(std::abs(closed[k] - solved[k]) <= 1e-13);
  });
}

TEST(relaxation_problem, at_epsilon_zero_implicit_stages_are_the_equilibrium_and_explicit_ones_unchanged) {
  auto problem = ode_model::as_relaxation(0.0);
  row u{2, 0.1};
  problem.solve_collision(0, 0.0, 0.0, u);
  EXPECT_EQ(u, (row{2, 0.1}));
  problem.solve_collision(0, 0.0, -1e-3, u);
  EXPECT_EQ(u, (row{2, std::sin(2.0)}));
}

namespace {

/// Asserts that one call for T + Q gives the same acc ← acc + α u + β (T + Q) as one call for T and
/// one for Q.
template <class Problem>
void expect_sum_of_both(Problem problem, const row& u, double alpha, double beta, bool fresh) {
  row joint{0.5, -0.25}, in_turn = joint;
  const apsis::target<row, double> together{&joint, alpha, beta, fresh}, first{&in_turn, alpha, beta, fresh},
      second{&in_turn, 0.0, beta, false};
  problem.add_transport_and_collision(0, u, {&together, 1});
  problem.add_transport(0, u, {&first, 1});
  problem.add_collision(0, u, {&second, 1});
  // The tolerance covers rounding errors of the largest term, Q ≤ 10 (3 + 3)/ε.
  for (std::size_t k = 0; k < 2; ++k)
    RC_ASSERT(std::abs(joint[k] - in_turn[k]) <= 4 * rounding * (10 + 60 * std::abs(beta) / 0.01));
}

}  // namespace

TEST(relaxation_problem, adds_transport_and_collision_together) {
  check_property("T + Q", [] {
    const double epsilon = magnitude(-2, 0), alpha = uniform(-1, 1), beta = one_in(4) ? 0.0 : uniform(-1, 1);
    const row u{uniform(-3, 3), uniform(-3, 3)};
    const bool fresh = one_in(2);
    expect_sum_of_both(ode_model::as_relaxation(epsilon), u, alpha, beta, fresh);
    expect_sum_of_both(ode_model::as_newton(epsilon), u, alpha, beta, fresh);
  });
}

TEST(relaxation_problem, rejects_explicit_collision_at_epsilon_zero) {
  auto problem = ode_model::as_relaxation(0.0);
  const row u{2, 0};
  row acc(2);
  const apsis::target<row, double> to{&acc, 0.0, 1.0, true}, weight_only{&acc, 1.0, 0.0, true};
  EXPECT_THROW(problem.add_collision(0, u, {&to, 1}), apsis::input_error);
  EXPECT_THROW(problem.add_transport_and_collision(0, u, {&to, 1}), apsis::input_error);
  problem.add_collision(0, u, {&weight_only, 1});
  EXPECT_EQ(acc, u);
}

TEST(relaxation_problem, reports_why_a_state_is_invalid) {
  auto problem = ode_model::as_relaxation(1.0);
  row bad{2, std::nan("")};
  EXPECT_THROW(problem.solve_collision(0, 1.0, 0.0, bad), apsis::numerical_error);
  bad = {infinity, 0};
  EXPECT_THROW(problem.solve_collision(0, 0.0, 0.0, bad), apsis::numerical_error);
  row f{-1, 0, 0};  // ρ < 0, so the rate is negative
  EXPECT_THROW(broadwell(1.0).solve_collision(0, 1.0, 0.0, f), apsis::numerical_error);
  problem.with_admissible([](const row& u) { return u[0] > 3; });
  row u{2, 0};
  EXPECT_THROW(problem.solve_collision(0, 1.0, 0.0, u), apsis::numerical_error);
  for (const double epsilon : {-1.0, infinity, std::nan("")})
    EXPECT_THROW(ode_model::as_relaxation(epsilon), apsis::input_error) << epsilon;
}

TEST(relaxation_problem, forward_euler_step_is_infinite_unless_set) {
  auto problem = ode_model::as_relaxation(1.0);
  EXPECT_EQ(problem.forward_euler_step(0, {2, 0}), infinity);
  problem.with_forward_euler_step([](double t, const row& u) { return t + u[0]; });
  EXPECT_EQ(problem.forward_euler_step(1, {2, 0}), 3);
}

TEST(accumulate, evaluates_at_most_once_and_only_if_a_target_needs_it) {
  const row u{1, 2}, slope{10, 20};
  int evaluations = 0;
  const auto evaluate = [&]() -> const row& {
    ++evaluations;
    return slope;
  };
  row first{std::nan(""), std::nan("")}, second{100, 100}, self = u;
  const std::vector<apsis::target<row, double>> both{{&first, 2.0, 0.5, true}, {&second, 1.0, 1.0, false}};
  apsis::accumulate<row>(both, u, evaluate);
  EXPECT_EQ(evaluations, 1);
  EXPECT_EQ(first, (row{7, 14}));
  EXPECT_EQ(second, (row{111, 122}));
  const apsis::target<row, double> in_place{&self, 3.0, 0.0, true};
  apsis::accumulate<row>({&in_place, 1}, self, evaluate);
  EXPECT_EQ(evaluations, 1);
  EXPECT_EQ(self, (row{3, 6}));
}

}  // namespace

namespace {

/// u' = (u[1], 0) + (E(w) − u)/1 with w = `moments`(u) = u[0]. E has the moment `kept_share` w.
auto two_numbers(double kept_share) {
  return apsis::relaxation_problem(
      [](double, const std::vector<double>& u, std::vector<double>& T) { T = {u[1], 0.0}; },
      [](const std::vector<double>& u) { return u[0]; },
      [kept_share](double w, std::vector<double>& E) { E = {kept_share * w, 0.5 * w}; },
      [](double) { return 1.0; }, 1.0);
}

/// Returns the error message of a step of the method.
template <class Problem>
std::string complaint_of_step(Problem problem, const std::string& method) {
  apsis::stepper march(apsis::find_method(method), problem);
  std::vector<double> u{2.0, 1.0};
  try {
    march.step(0.0, 0.1, u);
  } catch (const apsis::input_error& refused) {
    EXPECT_EQ(u, (std::vector<double>{2.0, 1.0}));
    return refused.what();
  }
  return "";
}

}  // namespace

TEST(relaxation_problem, rejects_an_equilibrium_with_wrong_moments) {
  EXPECT_EQ(complaint_of_step(two_numbers(1.0), "md-imex-3-2"), "");
  EXPECT_EQ(complaint_of_step(two_numbers(1.0 + 1e-12), "md-imex-3-2"), "");
  EXPECT_EQ(
      complaint_of_step(two_numbers(1.001), "md-imex-3-2"),
      "the equilibrium does not have the given moments (R E(w) differs from w by 0.001 of the largest); "
      "correct the equilibrium or the moments");
  // A range of moments is compared one by one.
  const apsis::relaxation_problem ranged(
      [](double, const std::vector<double>&, std::vector<double>& T) { T = {0.0, 0.0}; },
      [](const std::vector<double>& u) { return std::array{u[0] + u[1], u[0] - u[1]}; },
      [](const std::array<double, 2>& w, std::vector<double>& E) { E = {w[0] / 2, w[0] / 2}; },
      [](const std::array<double, 2>&) { return 1.0; }, 1.0);
  EXPECT_NE(complaint_of_step(ranged, "md-imex-3-2").find("differs from w by 0.33 of"), std::string::npos);
}

/// Pairs (u, v) side by side with w = u + v, E = (w²/16, w − w²/16), T = −u/10 and a rate for each pair.
auto pairs(const row& rates) {
  return apsis::relaxation_problem(
      [](double, const row& u, row& T) {
        for (std::size_t i = 0; i < u.size(); ++i) T[i] = -0.1 * u[i];
      },
      [](const row& u) {
        row w(u.size() / 2);
        for (std::size_t i = 0; i < w.size(); ++i) w[i] = u[2 * i] + u[2 * i + 1];
        return w;
      },
      [](const row& w, row& E) {
        for (std::size_t i = 0; i < w.size(); ++i) {
          E[2 * i] = w[i] * w[i] / 16.0;
          E[2 * i + 1] = w[i] - E[2 * i];
        }
      },
      [rates](const row&, row& C) {
        for (std::size_t i = 0; i < C.size(); ++i) C[i] = rates[i * rates.size() / C.size()];
      },
      0.5);
}

TEST(relaxation_problem, systems_side_by_side_have_rates_of_their_own) {
  const row rates = {0.0, 1e-3, 1.0, 1e6, 1e15};
  for (const std::string name : {"md-imex-8-3-mixed", "ark-436", "exponential-2"}) {
    const apsis::method& m = apsis::find_method(name);
    const auto solve = [&m](const row& own, row u) {
      auto problem = pairs(own);
      apsis::exact_collisions exact(problem);
      const auto rule = apsis::step_rule<double>::fixed(0.25);
      if (apsis::solves_exactly(m.kind)) {
        apsis::stepper march(m, exact);
        apsis::integrate(march, u, 0.0, 1.0, rule);
      } else {
        apsis::stepper march(m, problem);
        apsis::integrate(march, u, 0.0, 1.0, rule);
      }
      return u;
    };
    row start;
    for (std::size_t i = 0; i < rates.size(); ++i)
      start.insert(start.end(), {2.0 + static_cast<double>(i), 0.5});
    const row together = solve(rates, start);
    for (std::size_t i = 0; i < rates.size(); ++i) {
      const row alone = solve({rates[i]}, {start[2 * i], start[2 * i + 1]});
      EXPECT_EQ((row{together[2 * i], together[2 * i + 1]}), alone) << name << " " << rates[i];
    }
  }
}

TEST(relaxation_problem, rejects_rates_that_do_not_conserve_the_moments) {
  EXPECT_EQ(complaint_of_step(pairs({1.0, 1.0}), "md-imex-3-2"), "");
  const std::string complaint = complaint_of_step(pairs({1.0, 2.0}), "md-imex-3-2");
  EXPECT_EQ(complaint.substr(0, 45), "the rates do not conserve the moments (w chan") << complaint;
}

TEST(method_without_transport, is_rejected_for_problems_with_transport) {
  EXPECT_EQ(complaint_of_step(two_numbers(1.0), "imdrk-2-3"),
            "method 'imdrk-2-3' cannot integrate this problem (it is implicit only and the problem has "
            "transport); choose an IMEX or explicit method");
  const auto collision = [](const auto& u, auto& out) {
    out[0] = -u[0];
    out[1] = u[0];
  };
  apsis::newton_problem moving([](double, const std::vector<double>& u, std::vector<double>& T) { T = u; },
                               collision);
  EXPECT_NE(complaint_of_step(moving, "imdrk-2-3").find("is implicit only"), std::string::npos);
  apsis::newton_problem still(apsis::no_transport{}, collision);
  EXPECT_EQ(complaint_of_step(still, "imdrk-2-3"), "");
}

TEST(rule_of_ssp_steps, requires_a_method_with_an_ssp_coefficient) {
  auto problem = two_numbers(1.0);
  problem.with_forward_euler_step([](double, const std::vector<double>&) { return 0.1; });
  const auto run = [&](const std::string& method, apsis::step_rule<double> rule) {
    apsis::stepper march(apsis::find_method(method), problem);
    std::vector<double> u{2.0, 1.0};
    return apsis::integrate(march, u, 0.0, 1.0, rule).steps;
  };
  EXPECT_EQ(run("md-imex-3-2", apsis::step_rule<double>::ssp()), 10);
  EXPECT_EQ(run("ars-443", apsis::step_rule<double>::fixed(0.1)), 10);
  try {
    run("ars-443", apsis::step_rule<double>::ssp());
    FAIL() << "steps of r dt_FE with r = 0";
  } catch (const apsis::input_error& refused) {
    EXPECT_STREQ(
        refused.what(),
        "method 'ars-443' has no step length in units of the forward Euler step (its SSP coefficient is "
        "0); give dt, or choose a method with an SSP coefficient");
  }
}

}  // namespace relaxation_problem_test
