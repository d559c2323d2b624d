// Tolerances of single unknowns in the norm, in the step control, and at the end of Newton's iterations.
#include <apsis/integrate/component_tolerances.hpp>

#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/newton_problem.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <integrate/random.hpp>
#include <support/bad_input.hpp>
#include <support/property.hpp>

namespace component_tolerances_test {
namespace {

using apsis::component_tolerances;
using apsis::newton_problem;
using apsis::no_transport;
using random_input::magnitude;
using random_input::uniform;
using row = std::vector<double>;
constexpr double infinity = std::numeric_limits<double>::infinity(),
                 nan = std::numeric_limits<double>::quiet_NaN();

TEST(component_tolerances, compare_every_unknown_with_its_own) {
  const component_tolerances<double> t({1e-3, 1e-3}, {1e-6, 10});
  EXPECT_NEAR(t(row{1, 1}, row{1 + 1e-2, 1}), 1e-2 / (1e-3 * 1.01 + 1e-6), 1e-13);  // rounding of 1.01
  EXPECT_DOUBLE_EQ(t(row{1, 1}, row{1, 2}), 1 / (1e-3 * 2 + 10));
  EXPECT_EQ(t(row{0, 0}, row{0, 0}), 0);
  EXPECT_EQ(component_tolerances(1e-3, 0.0)(row{0, 1}, row{0, 1}), 0);  // 0 of 0
}

TEST(component_tolerances, distances_are_symmetric_and_change_with_scales_of_the_unknowns) {
  check_property("units of an unknown do not matter if atol has them too", [] {
    const row u{magnitude(-6, 6), uniform(-1, 1)}, v{magnitude(-6, 6), uniform(-1, 1)};
    const double unit = std::exp2(std::round(uniform(-60, 60)));
    const component_tolerances<double> t({1e-4, 1e-5}, {1e-7, 1e-3}),
        scaled({1e-4, 1e-5}, {1e-7 * unit, 1e-3});
    RC_ASSERT(t(u, v) == t(v, u));
    RC_ASSERT(t(u, v) == scaled(row{u[0] * unit, u[1]}, row{v[0] * unit, v[1]}));
  });
}

TEST(component_tolerances, no_step_with_a_number_that_is_not_finite_is_within_them) {
  const component_tolerances<double> t(1e-3, 1e-3);
  for (const double bad : {nan, infinity, -infinity}) {
    EXPECT_FALSE(t(row{1, bad}, row{1, 1}) <= 1);
    EXPECT_FALSE(t(row{bad, 1}, row{bad, 1}) <= 1);
  }
}

TEST(component_tolerances, refuse_what_is_no_tolerance) {
  bad_input::expect_refused({
      {[] { component_tolerances<double>(-1e-3, 0.0); }, {"unknown 0", "negative"}, 2},
      {[] { component_tolerances<double>(1e-3, nan); }, {"unknown 0", "not finite"}, 2},
      {[] { component_tolerances<double>({1e-3, 0}, {0, 0}); }, {"unknown 1 has no tolerance"}, 2},
      {[] { component_tolerances<double>(row{1e-3}, row{}); }, {"the list is empty"}, 2},
      {[] { component_tolerances<double>({1e-3, 1e-3}, {0, 0, 0}); }, {"2 relative and 3 absolute"}, 2},
      {[] { component_tolerances<double>(row{1e-3}, row{1, 1, 1})(row{1, 1}, row{1, 1}); },
       {"3 tolerances and 2 unknowns"},
       2},
  });
}

/// Two independent unknowns, one with the rate −1 and one with −100.
constexpr auto apart = [](const auto& u, auto& out) {
  out[0] = -1.0 * u[0];
  out[1] = -100.0 * (u[1] - 1.0);
};

struct outcome {
  row u;
  long steps;
};

outcome integrate(const component_tolerances<double>& tolerances) {
  newton_problem problem(no_transport{}, apart);
  problem.with_tolerances(tolerances);
  const apsis::method& m = apsis::find_method("imdrk-9-5");
  apsis::stepper march(m, problem, apsis::solutions::result_and_embedded);
  apsis::step_controller<double> control(1.0, apsis::estimate_of(m).order);
  row u{1, 2};
  const auto done = apsis::integrate_to_tolerance(march, u, 0.0, 1.0, apsis::step_rule<double>::unlimited(),
                                                  control, tolerances);
  return {u, done.steps};
}

TEST(component_tolerances, an_unknown_with_a_wide_tolerance_costs_no_steps) {
  const auto both = integrate({1e-8, 1e-8}), slow = integrate({{1e-8, 1e-8}, {1e-8, 1e3}});
  EXPECT_LT(3 * slow.steps, both.steps);
  EXPECT_NEAR(slow.u[0], std::exp(-1.0), 1e-7);  // 10 tolerances
  EXPECT_NEAR(both.u[0], std::exp(-1.0), 1e-7);
  EXPECT_NEAR(both.u[1], 1, 1e-7);
}

TEST(component_tolerances, the_first_step_changes_what_has_a_tolerance) {
  // The fast layer of the second unknown is below its atol. The first step then follows from the rate 1.
  newton_problem problem(no_transport{}, apart);
  const apsis::error_target<double> target{1.0, 3};
  const row u{1, 2};
  const double strict =
                   apsis::first_step_length(problem, 0.0, u, 1.0, target, component_tolerances(1e-8, 1e-8)),
               loose = apsis::first_step_length(problem, 0.0, u, 1.0, target,
                                                component_tolerances<double>({1e-8, 1e-8}, {1e-8, 1e3}));
  EXPECT_NEAR(loose / strict, 50, 5);  // rates relative to u: 1, and 100/2
}

TEST(component_tolerances, the_first_step_does_not_depend_on_the_length_of_the_interval) {
  // Robertson's reaction. Over a long time u_1 changes by as much as its tolerance allows.
  const auto g = [](const auto& u, auto& out) {
    out[0] = -0.04 * u[0] + 1e4 * u[1] * u[2];
    out[2] = 3e7 * u[1] * u[1];
    out[1] = -out[0] - out[2];
  };
  newton_problem problem(no_transport{}, g);
  const row u{1, 0, 0};
  const apsis::error_target<double> target{1.0, 4};
  const component_tolerances<double> tolerances({1e-6}, {1e-10, 1e-14, 1e-10});
  const double in_short = apsis::first_step_length(problem, 0.0, u, 1e-6, target, tolerances);
  EXPECT_LT(in_short, 1e-7);
  for (const double length : {1e-3, 1.0, 1e5, 1e11})
    EXPECT_NEAR(apsis::first_step_length(problem, 0.0, u, length, target, tolerances) / in_short, 1.0, 0.1);
}

TEST(newton_problem, ends_stage_solves_within_the_tolerance) {
  // u' = −u³, whose stages v = u + a G(v) are cubic equations. Without tolerances the result is the root up
  // to rounding. With them the error is far below the tolerance, because Newton's method converges
  // quadratically, and fewer matrices are needed.
  const auto cubic = [](const auto& u, auto& out) { out[0] = -1.0 * u[0] * u[0] * u[0]; };
  newton_problem exact(no_transport{}, cubic), early(no_transport{}, cubic);
  early.with_tolerances({1e-4, 1e-4});
  int saved = 0;
  for (const double a : {0.1, 1.0, 10.0, 1e4}) {
    row v{1}, w{1};
    exact.solve_collision(0, a, 0.0, v);
    early.solve_collision(0, a, 0.0, w);
    EXPECT_NEAR(v[0] + a * v[0] * v[0] * v[0], 1, 1e-14) << a;
    EXPECT_NEAR(w[0], v[0], 1e-3 * 1e-4) << a;
    saved += exact.report().factorizations - early.report().factorizations;
  }
  EXPECT_GE(saved, 4);  // at least one for each stage
}

TEST(newton_problem, conserves_sums_however_wide_the_tolerance) {
  const auto exchange = [](const auto& u, auto& out) {
    const auto rate = 1e6 * (u[0] * u[0] - u[1]) + u[0] * u[1];
    out[0] = -1.0 * rate;
    out[1] = rate;
  };
  for (const double share : {1e-3, 1.0}) {
    newton_problem problem(no_transport{}, exchange);
    problem.with_tolerances({1e-2, 1e-2}, share);
    for (const double dt : {1e-6, 1e-3, 1.0, 1e3}) {
      row u{0.25, 0.75};
      problem.solve_collision(0, dt, -0.5 * dt * dt, u);
      EXPECT_NEAR(u[0] + u[1], 1, 1e-13) << share << " " << dt;
    }
  }
  newton_problem problem(no_transport{}, exchange);
  bad_input::expect_refused(
      {{[&] { problem.with_tolerances({1e-2, 1e-2}, 0); }, {"share of the tolerance"}, 2}});
}

TEST(newton_problem, a_stage_far_below_its_tolerance_is_solved) {
  // Two unknowns have decayed to 1e-40, beside one of size 1e-20 of a stiff pair. Iterations that resolve the
  // rounding of each unknown would wander among rounding errors of the large one.
  const auto pair = [](const auto& y, auto& f) {
    const auto a = 7.89e-10 * y[0], b = 1.1e7 * y[0] * y[2], c = 1.13e9 * y[1] * y[2], d = 1.13e3 * y[3];
    f[0] = -1.0 * a - b;
    f[1] = a - c;
    f[3] = b - d;
    f[2] = f[1] - f[3];
  };
  newton_problem problem(no_transport{}, pair);
  problem.with_tolerances({1e-6, 1.7e-24});
  for (const double dt : {1e6, 1e8, 1e10}) {
    row u{7.37e-48, 2.56e-20, 2.56e-20, 2.2e-64};
    const row start = u;
    problem.solve_collision(0, 0.3 * dt, -0.05 * dt * dt, u);
    EXPECT_NEAR(u[1] / u[2], 1, 1e-12) << dt;
    EXPECT_LT(u[1], start[1]) << dt;
    EXPECT_GT(u[1], 0) << dt;
  }
}

}  // namespace
}  // namespace component_tolerances_test
