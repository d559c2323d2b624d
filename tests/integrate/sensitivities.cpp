// Derivatives of solutions by parameters: exact solutions, differences of numerical solutions, invariants.
#include <apsis/integrate/sensitivities.hpp>

#include <apsis/integrate/any_stepper.hpp>
#include <apsis/integrate/evolution.hpp>
#include <apsis/integrate/newton_problem.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <integrate/random.hpp>
#include <support/bad_input.hpp>
#include <support/property.hpp>

namespace sensitivities_test {
namespace {

using apsis::newton_problem;
using apsis::no_transport;
using apsis::sensitivities;
using random_input::uniform;
using row = std::vector<double>;

/// Robertson's reaction with its three rates as parameters.
constexpr auto robertson = [](const auto& u, const auto& p, auto& out) {
  const auto first = -p[0] * u[0] + p[1] * u[1] * u[2], third = p[2] * u[1] * u[1];
  out[0] = first;
  out[1] = -1.0 * first - third;
  out[2] = third;
};
const row rates{0.04, 1e4, 3e7};

/// u' = −p₀ (u − cos(p₁ t)): a source that depends on time.
constexpr auto driven = [](const auto& t, const auto& u, const auto& p, auto& out) {
  using std::cos;
  out[0] = -p[0] * (u[0] - cos(p[1] * t));
};
/// The solution with u(0) = 0: p₀ (p₀ cos p₁t + p₁ sin p₁t − p₀ e^{−p₀t})/(p₀² + p₁²).
double driven_solution(double p, double q, double t) {
  return p * (p * std::cos(q * t) + q * std::sin(q * t) - p * std::exp(-p * t)) / (p * p + q * q);
}

/// Returns the central difference quotient of a function, to about ten digits.
template <class F>
double slope(const F& of, double x) {
  const double h = 6e-6 * std::max(1.0, std::abs(x));
  return (of(x + h) - of(x - h)) / (2 * h);
}

TEST(sensitivities, of_a_driven_decay_are_those_of_its_solution) {
  // With order 5 and Q that depends on time; without and with Q̇.
  for (const std::string name : {"ark-548-2", "imdrk-9-5", "extrapolated-euler-5"}) {
    const double p = 3, q = 2;
    sensitivities g(driven, row{p, q});
    newton_problem problem(no_transport{}, g);
    const apsis::component_tolerances<double> wanted(1e-9, 1e-9);
    problem.with_tolerances(wanted);
    apsis::evolution march(apsis::find_method(name), problem, apsis::step_rule<double>::unlimited(),
                           apsis::step_tolerance<row, double>{1.0, wanted, std::nullopt});
    march.start(0, g.start(row{0}));
    march.advance(2);
    // Errors of some hundred steps of 1e-9, and of differences of the exact solution.
    EXPECT_NEAR(march.u()[0], driven_solution(p, q, 2), 1e-7) << name;
    EXPECT_NEAR(march.u()[1], slope([&](double x) { return driven_solution(x, q, 2); }, p), 1e-7) << name;
    EXPECT_NEAR(march.u()[2], slope([&](double x) { return driven_solution(p, x, 2); }, q), 1e-7) << name;
  }
}

template <class P>
row end_of(const std::string& method, P& problem, row u) {
  apsis::with_stepper(apsis::find_integrator(method), problem, [&](auto march) {
    apsis::integrate(march, u, 0.0, 1.0, apsis::step_rule<double>::fixed(0.125));
  });
  return u;
}

TEST(sensitivities, of_equal_steps_are_derivatives_of_the_numerical_solution) {
  // An explicit F and an implicit G, both with the parameters.
  const auto f = [](const auto& t, const auto& u, const auto& p, auto& out) {
    using std::sin;
    out[0] = p[0] * u[1] * sin(t);
    out[1] = -1.0 * u[0] * p[1];
  };
  const auto g = [](const auto& u, const auto& p, auto& out) {
    out[0] = -20.0 * p[0] * u[0] * u[0] * u[0];
    out[1] = p[1] * (u[0] - u[1]);
  };
  const row p{1.5, 3}, u0{1, 0.5};
  for (const std::string name :
       {"md-imex-8-3-mixed", "md-imex-16-4-efficient", "ark-436", "extrapolated-euler-4", "imex-bdf-3",
        "imex-dimsim-3", "two-step-10-3-mixed"}) {
    sensitivities sg(g, p);
    sensitivities sf(f, p);
    newton_problem problem(sf, sg);
    const row all = end_of(name, problem, sg.start(u0));
    for (std::size_t k = 0; k < 2; ++k)
      for (std::size_t i = 0; i < 2; ++i) {
        const double expected = slope(
            [&](double x) {
              row changed = p;
              changed[k] = x;
              newton_problem plain([&](double t, const row& u, row& out) { f(t, u, changed, out); },
                                   [&](const auto& u, auto& out) {
                                     using scalar = std::remove_cvref_t<decltype(u[0])>;
                                     g(u, std::vector<scalar>(changed.begin(), changed.end()), out);
                                   });
              return end_of(name, plain, u0)[i];
            },
            p[k]);
        // Rounding of differences: 1e-15/6e-6, and their truncation (6e-6)² times a third derivative.
        EXPECT_NEAR(sg.part(all, k)[i], expected, 1e-8) << name << " " << k << " " << i;
      }
  }
}

TEST(sensitivities, of_robertson_s_reaction_conserve_mass_dense_and_sparse) {
  row ends[2];
  for (const bool sparse : {false, true}) {
    sensitivities g(robertson, rates);
    newton_problem problem(no_transport{}, g);
    if (sparse) problem.with_sparsity(g.pattern(apsis::sparsity_pattern::banded(3, 2, 2)));
    // Tolerances of u, and of s_k for relative changes of the rates.
    row absolute{1e-8, 1e-12, 1e-8};
    for (const double rate : rates)
      for (std::size_t i = 0; i < 3; ++i) absolute.push_back(absolute[i] / rate);
    const apsis::component_tolerances<double> wanted(row(absolute.size(), 1e-7), absolute);
    problem.with_tolerances(wanted);
    apsis::evolution march(apsis::find_method("ark-548-2"), problem, apsis::step_rule<double>::unlimited(),
                           apsis::step_tolerance<row, double>{1.0, wanted, std::nullopt});
    march.start(0, g.start(row{1, 0, 0}));
    march.advance(400);
    ends[sparse ? 1 : 0] = march.u();
    // Σ u = 1 for all rates. Rounding of some hundred steps.
    const row& u = march.u();
    EXPECT_NEAR(u[0] + u[1] + u[2], 1, 1e-12);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto s = g.part(u, k);
      EXPECT_NEAR(s[0] + s[1] + s[2], 0, 1e-10 * std::abs(s[0]));
    }
  }
  // Faster rates 0 and 2 make more of the third species, and a faster reverse reaction (rate 1) makes less.
  EXPECT_GT(ends[0][5], 0);
  EXPECT_LT(ends[0][8], 0);
  EXPECT_GT(ends[0][11], 0);
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_NEAR(ends[0][i], ends[1][i], 1e-5 * std::abs(ends[0][i])) << i;  // the tolerance of many steps
}

/// A function without third derivatives, which curvature() leaves out.
constexpr auto quadratic = [](const auto& u, const auto& p, auto& out) {
  out[0] = p[0] * u[0] + u[0] * u[1];
  out[1] = p[1] * u[1] + p[0] * p[1] * u[0] - 2.0 * u[0] * u[0];
};

TEST(sensitivities, derivatives_agree_with_differences) {
  check_property("random state and direction", [] {
    sensitivities g(quadratic, row{0.4, 2});
    row all(6), x(6), q(6), jx(6), hx(6), upper(6), lower(6), more(6), less(6);
    for (row* one : {&all, &x, &q})
      for (double& value : *one) value = uniform(-1, 1);
    g.jacobian_product(all, x, jx);
    g.curvature(all, q, x, hx);
    const double h = 1e-4;  // second differences of a quadratic function are exact but for rounding
    const auto at = [&](double a, double b, row& out) {
      row moved(6);
      for (std::size_t i = 0; i < 6; ++i) moved[i] = all[i] + a * x[i] + b * q[i];
      g.value(moved, out);
    };
    at(h, 0, upper);
    at(-h, 0, lower);
    for (std::size_t i = 0; i < 6; ++i) RC_ASSERT(std::abs((upper[i] - lower[i]) / (2 * h) - jx[i]) <= 1e-9);
    at(h, h, upper);
    at(-h, -h, lower);
    at(h, -h, more);
    at(-h, h, less);
    for (std::size_t i = 0; i < 6; ++i) {
      const double second = (upper[i] + lower[i] - more[i] - less[i]) / (4 * h * h);
      RC_ASSERT(std::abs(second - hx[i]) <= 1e-5);
    }
  });
}

TEST(sensitivities, refuse_what_is_no_parameter) {
  bad_input::expect_refused({
      {[] { sensitivities(robertson, row{}); }, {"no parameters"}, 2},
      {[] { sensitivities(robertson, row{1, std::numeric_limits<double>::infinity()}); },
       {"parameter 1", "not finite"},
       2},
  });
}

}  // namespace
}  // namespace sensitivities_test
