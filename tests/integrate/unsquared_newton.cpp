// Stages with fast directions 1e6 to 1e16 times as fast as the step. The rounding errors of (Δt λ)² must not
// hide the slow directions. Where they do, the stage must be refused.
#include <apsis/core/errors.hpp>
#include <apsis/integrate/difference_derivatives.hpp>
#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/newton_problem.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <integrate/ode_model.hpp>
#include <integrate/random.hpp>
#include <integrate/reference.hpp>
#include <support/bad_input.hpp>
#include <support/property.hpp>

namespace unsquared_newton_test {
namespace {

using apsis::linear_solver;
using apsis::newton_options;
using apsis::newton_problem;
using apsis::no_transport;
using random_input::magnitude;
using random_input::uniform;
using row = std::vector<double>;
using testing::HasSubstr;

constexpr auto robertson = [](const auto& v, auto& out) {
  const auto first = -0.04 * v[0] + 1e4 * v[1] * v[2], third = 3e7 * v[1] * v[1];
  out[0] = first;
  out[1] = -1.0 * first - third;
  out[2] = third;
};

/// Returns the largest difference relative to |u_k| + absolute_k.
auto relative_to(row absolute) {
  return [absolute](const row& u, const row& v) {
    double largest = 0.0;
    for (std::size_t k = 0; k < u.size(); ++k)
      largest = std::max(largest, std::abs(u[k] - v[k]) / (std::abs(u[k]) + absolute[k]));
    return largest;
  };
}

/// Integrates u' = G(u) to a tolerance, and returns the number of accepted and rejected steps.
template <class G>
long integrate(const std::string& method, const G& g, row& u, double end, double tolerance,
               const row& absolute) {
  newton_problem problem(no_transport{}, g);
  const apsis::method& m = apsis::find_method(method);
  apsis::stepper march(m, problem, apsis::solutions::result_and_embedded);
  apsis::step_controller<double> control(tolerance, apsis::estimate_of(m).order);
  const auto done = apsis::integrate_to_tolerance(march, u, 0.0, end, apsis::step_rule<double>::unlimited(),
                                                  control, relative_to(absolute));
  EXPECT_EQ(done.t, end);
  return done.steps + control.rejected();
}

class every_two_derivative_method : public ::testing::TestWithParam<std::string> {};

TEST_P(every_two_derivative_method, follows_robertson_to_any_time) {
  if (!reference::has_cvode) GTEST_SKIP() << "SUNDIALS was not found";
  // Errors at the end are at most 40 tolerances for these methods. A frozen stage would leave errors from 0.3
  // to 1000 times the solution.
  const double tolerance = 1e-5;
  for (const double end : {4e5, 4e7, 4e10, 4e11}) {
    row u{1, 0, 0};
    EXPECT_LT(integrate(GetParam(), robertson, u, end, tolerance, {1e-12, 1e-18, 1e-12}), 6000);
    const auto exact = reference::cvode_robertson(end);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(u[k] / exact[k], 1, 40 * tolerance) << end << " " << k;
    // There are a thousand steps of nine stages. Each changes the sum by one or two rounding errors.
    EXPECT_NEAR(u[0] + u[1] + u[2], 1, 1e-13) << end;
  }
}

INSTANTIATE_TEST_SUITE_P(unsquared_newton, every_two_derivative_method,
                         ::testing::Values("imdrk-3-3", "imdrk-7-4", "imdrk-9-5", "imdrk-9-5-accurate",
                                           "md-imex-6-3", "md-imex-8-3-mixed", "md-imex-16-4-efficient"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(unsquared_newton, reaches_the_published_end_of_robertson_s_problem) {
  // Mazzia & Magherini, Test Set for Initial Value Problem Solvers (2008), problem ROBER, t = 1e11.
  row u{1, 0, 0};
  integrate("imdrk-9-5", robertson, u, 1e11, 1e-8, {1e-12, 1e-18, 1e-12});
  EXPECT_NEAR(u[0] / 0.2083340149701255e-7, 1, 4e-7);  // 40 tolerances
  EXPECT_NEAR(u[1] / 0.8333360770334713e-13, 1, 4e-7);
  EXPECT_NEAR(u[2], 0.9999999791665050, 1e-12);
}

TEST(unsquared_newton, a_single_stage_far_beyond_the_fast_time_is_not_frozen) {
  // On the slow manifold at t = 1e6, v₀ and v₁ are far from those of the stage. The residual at the start is
  // within its rounding errors. Elimination solves v = u + a k + b G'(v) k with k = G(v).
  row u{0.002035, 8.16e-9, 0.997965 - 8.16e-9};
  const double a = 0.5e7, b = -0.125e14;
  newton_problem problem(no_transport{}, robertson);
  row v = u;
  problem.solve_collision(0, a, b, v);
  auto extended =
      apsis::make_newton_problem<std::vector<long double>>(no_transport{}, [](const auto& w, auto& out) {
        const auto first = -0.04L * w[0] + 1e4L * w[1] * w[2], third = 3e7L * w[1] * w[1];
        out[0] = first;
        out[1] = -1.0L * first - third;
        out[2] = third;
      });
  std::vector<long double> w(u.begin(), u.end());
  extended.solve_collision(0, a, b, w);
  EXPECT_LT(v[0], 0.9 * u[0]);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(v[k] / static_cast<double>(w[k]), 1, 1e-9) << k;
  EXPECT_NEAR(v[0] + v[1] + v[2], u[0] + u[1] + u[2], 1e-15);
}

/// u' = S diag(rates) S⁻¹ u for a rotation S. No single component is fast or slow.
struct rotated {
  double fast, slow, angle;
  template <class U, class V>
  void operator()(const U& u, V& out) const {
    const double c = std::cos(angle), s = std::sin(angle);
    const auto p = -fast * (c * u[0] + s * u[1]), q = -slow * (c * u[1] - s * u[0]);
    out[0] = c * p - s * q;
    out[1] = s * p + c * q;
  }
  row state(double p, double q) const {
    return {std::cos(angle) * p - std::sin(angle) * q, std::sin(angle) * p + std::cos(angle) * q};
  }
  double slow_part(const row& u) const { return std::cos(angle) * u[1] - std::sin(angle) * u[0]; }
};

TEST(unsquared_newton, mixed_fast_and_conserved_directions_stay_apart) {
  check_property("rates up to 1e12 beside 0 or 1, any rotation", [] {
    const rotated g{magnitude(0, 12), random_input::one_in(2) ? 0.0 : 1.0, uniform(0.1, 1.4)};
    newton_problem problem(no_transport{}, g);
    const double a = uniform(0.1, 1), b = random_input::one_in(3) ? 0.0 : -uniform(0.1, 1);
    row u = g.state(1, 2);
    problem.solve_collision(0, a, b, u);
    // Rounding the problem itself to double precision changes it by 1e-16 of Δt λ.
    RC_ASSERT(std::abs(g.slow_part(u) - 2 / (1 + a * g.slow - b * g.slow * g.slow)) <=
              2e-10 + 1e-15 * g.fast);
  });
}

TEST(unsquared_newton, refuses_what_rounding_hides_instead_of_returning_the_start) {
  for (const double b : {0.0, -0.125}) {
    const rotated g{1e17, 1, 0.7};
    newton_problem problem(no_transport{}, g);
    row u = g.state(1, 2);
    const row start = u;
    bad_input::expect_refused(
        {{[&] { problem.solve_collision(0, 0.5, b, u); }, {"singular to working precision"}, 3}});
    EXPECT_EQ(u, start);
  }
}

TEST(unsquared_newton, steps_are_controlled_whatever_the_fastest_rate) {
  for (const double fast : {1e6, 1e9, 1e12}) {
    const rotated g{fast, 1, 0.7};
    row u = g.state(1, 2);
    EXPECT_LT(integrate("imdrk-9-5", g, u, 5.0, 1e-6, {1e-6, 1e-6}), 150) << fast;
    EXPECT_NEAR(g.slow_part(u), 2 * std::exp(-5.0), 1e-7) << fast;
  }
}

TEST(unsquared_newton, van_der_pol_tends_to_its_limit_for_large_mu) {
  // The limit ε = 1/μ → 0 is u' = u/(1 − u²) from |u| = 2 to 1, which takes 3/2 − ln 2, and jumps to −2 sgn
  // u. After two jumps ln u − u²/2 = ln 2 − 2 + t − 2(3/2 − ln 2), solved here by bisection. Jumps change the
  // solution by O(ε^{2/3}).
  const double value = 3 * std::log(2.0) - 3;
  double low = 1, high = 2;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (std::log(middle) - 0.5 * middle * middle > value ? low : high) = middle;
  }
  for (const double mu : {1e8, 1e10, 1e12}) {
    row u{2, -2.0 / 3};
    const long steps = integrate("imdrk-9-5",
                                 [mu](const auto& v, auto& out) {
                                   out[0] = v[1];
                                   out[1] = ((1 - v[0] * v[0]) * v[1] - v[0]) * mu;
                                 },
                                 u, 2.0, 1e-6, {1e-6, 1e-6});
    EXPECT_LT(steps, 3000) << mu;
    EXPECT_NEAR(u[0], low, 1e-5 + 10 * std::pow(mu, -2.0 / 3)) << mu;
  }
}

TEST(unsquared_newton, small_unknowns_are_solved_to_their_own_rounding) {
  // The residual of the large unknown is a million times the small one. G couples them by the square of the
  // small one.
  const auto g = [](const auto& u, auto& out) {
    out[0] = -1.0 * u[0];
    out[1] = 1e-20 * u[0] - u[1] - 1e18 * u[1] * u[1];
  };
  newton_problem problem(no_transport{}, g);
  row v{1, 1e-18};
  problem.solve_collision(0, 1.0, 0.0, v);
  // 1e18 x² + 2x = 1e-18 + 1e-20/2 with x = y 1e-18: y² + 2y = 1.005
  EXPECT_NEAR(v[0], 0.5, 1e-16);
  EXPECT_NEAR(v[1] * 1e18, std::sqrt(2.005) - 1, 1e-14);
}

/// Derivatives by hand, which count their calls.
struct decay_by_hand {
  int* products;
  void value(std::span<const double> u, std::span<double> out) const {
    out[0] = -1e8 * (u[0] * u[0] - u[1]);
    out[1] = 1e8 * (u[0] * u[0] - u[1]) - u[1];
  }
  void jacobian_product(std::span<const double> u, std::span<const double> x, std::span<double> jx) const {
    ++*products;
    jx[0] = -1e8 * (2 * u[0] * x[0] - x[1]);
    jx[1] = 1e8 * (2 * u[0] * x[0] - x[1]) - x[1];
  }
  void curvature(std::span<const double>, std::span<const double> k, std::span<const double> x,
                 std::span<double> hx) const {
    hx[0] = -2e8 * k[0] * x[0];
    hx[1] = 2e8 * k[0] * x[0];
  }
};

// One of two rates vanishes. Once, rounding errors of the linear solve counted as its size, and one run in
// five ended without a solution.
TEST(unsquared_newton, ends_where_a_rate_vanishes) {
  for (const char* method : {"md-imex-6-3", "md-imex-16-4-accurate"})
    for (const double epsilon : {1e-6, 1e-8, 1e-10})
      for (int k = 0; k < 20; ++k) {
        auto by_newton = ode_model::as_newton(epsilon);
        auto in_closed_form = ode_model::as_relaxation(epsilon);
        row u{2 + 1e-3 * k, 0}, expected = u;
        apsis::stepper march(apsis::find_method(method), by_newton);
        apsis::stepper closed(apsis::find_method(method), in_closed_form);
        const auto rule = apsis::step_rule<double>::fixed(1.0 / 64);
        apsis::integrate(march, u, 0.0, 1.0, rule);
        apsis::integrate(closed, expected, 0.0, 1.0, rule);
        // There are 64 steps of about 16 stages. Their rounding errors are below 1e-13.
        EXPECT_NEAR(u[0], expected[0], 1e-12) << method << ", epsilon " << epsilon << ", " << k;
        EXPECT_NEAR(u[1], expected[1], 1e-12) << method << ", epsilon " << epsilon << ", " << k;
      }
}

// Once, iterations whose corrections were errors of differences in time did not end: 200 of them failed.
TEST(unsquared_newton, ends_where_differences_have_more_than_rounding_errors) {
  const auto g = [](double t, std::span<const double> u, std::span<double> out) {
    for (std::size_t i = 0; i < u.size(); ++i) out[i] = static_cast<double>(1 + i) * (t - u[i]) + 1.0;
  };
  for (int k = 1; k <= 40; ++k) {
    newton_problem problem(no_transport{},
                           apsis::difference_derivatives<decltype(g)>(g, 1e-2 / static_cast<double>(k)));
    problem.with_sparsity(apsis::sparsity_pattern::banded(2, 0, 0));
    apsis::stepper march(apsis::find_method("imdrk-3-3"), problem);
    row u{0, 0};
    apsis::integrate(march, u, 0.0, 1.0, apsis::step_rule<double>::fixed(0.125));
    // The solution is t, without errors of the method. Differences over 6e-6 of the time scale have errors
    // up to 1e-16/(6e-6 2.5e-4), which eight steps multiply by Δt².
    for (const double one : u) EXPECT_NEAR(one, 1.0, 1e-8) << k;
  }
}

TEST(newton_problem, accepts_derivatives_by_hand) {
  int products = 0;
  newton_problem by_hand(no_transport{}, decay_by_hand{&products});
  newton_problem automatic(no_transport{}, [](const auto& u, auto& out) {
    const auto pairs = 1e8 * (u[0] * u[0] - u[1]);
    out[0] = -1.0 * pairs;
    out[1] = pairs - u[1];
  });
  for (const double dt : {1e-9, 1e-5, 1.0}) {
    row u{1.0, 0.3}, v = u;
    by_hand.solve_collision(0, dt, -0.5 * dt * dt, u);
    automatic.solve_collision(0, dt, -0.5 * dt * dt, v);
    for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(u[k], v[k], 1e-13) << dt;
  }
  EXPECT_GT(products, 0);
}

TEST(newton_problem, of_more_than_200_dense_unknowns_is_warned_about_once) {
  const auto decay = [](const auto& u, auto& out) {
    for (std::size_t i = 0; i < u.size(); ++i) out[i] = -1.0 * u[i];
  };
  const auto warnings_of = [&](std::size_t n, linear_solver solver) {
    newton_problem problem(no_transport{}, decay, newton_options{solver});
    testing::internal::CaptureStderr();
    for (int k = 0; k < 2; ++k) {
      row u(n, 1.0);
      problem.solve_collision(0, 0.1, 0.0, u);
    }
    return testing::internal::GetCapturedStderr();
  };
  const std::string once = warnings_of(201, linear_solver::dense);
  EXPECT_THAT(once, HasSubstr("201 unknowns"));
  EXPECT_THAT(once, HasSubstr("linear_solver::krylov"));
  EXPECT_EQ(once.find("unknowns"), once.rfind("unknowns"));
  EXPECT_EQ(warnings_of(200, linear_solver::dense), "");
  EXPECT_EQ(warnings_of(300, linear_solver::automatic), "");
}

TEST(unsquared_newton, iterates_never_leave_the_admissible_set) {
  double smallest = 1;
  const auto g = [&smallest](const auto& u, auto& out) {
    using std::sqrt;
    smallest = std::min(smallest, static_cast<double>(u[0]));
    out[0] = -1e8 * (sqrt(u[0]) - u[1]);
    out[1] = 1e8 * (sqrt(u[0]) - u[1]) - u[1];
  };
  newton_problem problem(no_transport{}, g);
  problem.with_admissible([](std::span<const double> v) { return v[0] > 0 && v[1] > 0; });
  row u{1e-6, 1};
  problem.solve_collision(0, 1.0, -0.5, u);
  EXPECT_GT(smallest, 0);
  EXPECT_GT(u[0], 0);
  EXPECT_NEAR(std::sqrt(u[0]) / u[1], 1, 1e-6);
}

}  // namespace
}  // namespace unsquared_newton_test
