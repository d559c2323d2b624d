// Stages of a step share a derivative: cost and accuracy. A step depends on its beginning alone.
#include <apsis/integrate/evolution.hpp>
#include <apsis/integrate/newton_problem.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>
#include <integrate/random.hpp>
#include <support/property.hpp>

namespace simplified_newton_test {
namespace {

using apsis::component_tolerances;
using apsis::newton_problem;
using apsis::no_transport;
using apsis::sparsity_pattern;
using random_input::magnitude;
using random_input::uniform;
using row = std::vector<double>;

/// Robertson's reactions. The object counts evaluations of values and of derivatives.
struct robertson {
  long* values;
  long* products;

  template <class U, class V>
  void operator()(const U& y, V& f) const {
    ++*(std::is_same_v<std::decay_t<decltype(f[0])>, double> ? values : products);
    const auto first = -0.04 * y[0] + 1e4 * y[1] * y[2], third = 3e7 * y[1] * y[1];
    f[0] = first;
    f[1] = -1.0 * first - third;
    f[2] = third;
  }
};

const component_tolerances<double> tolerances({1e-6}, {1e-10, 1e-14, 1e-10});

TEST(simplified_newton, a_step_takes_one_derivative_and_one_matrix_for_each_coefficient) {
  // The step has twenty-one stages with six coefficients, dt/1 to dt/6. G is affine.
  long values = 0, products = 0;
  const auto affine = [&](const auto& u, auto& out) {
    ++(std::is_same_v<std::decay_t<decltype(out[0])>, double> ? values : products);
    out[0] = -1e3 * (u[0] - 2.0 * u[1]);
    out[1] = u[0] - 3.0 * u[1] + 1.0;
  };
  newton_problem problem(no_transport{}, affine);
  problem.with_tolerances({1e-6, 1e-6});
  apsis::stepper march(apsis::find_method("extrapolated-euler-6"), problem,
                       apsis::solutions::result_and_embedded);
  row u{1, 1};
  march.attempt(0.0, 0.1, u);
  EXPECT_EQ(products, 2);
  // The first two corrections measure the contraction. Every other stage needs one correction, after one
  // evaluation of G.
  EXPECT_LE(values, 2 * 21);
  // Another attempt from the same beginning needs no new derivative, but a step from another one does.
  march.attempt(0.0, 0.05, u);
  EXPECT_EQ(products, 2);
  const auto second = march.attempt(0.0, 0.05, u).result;
  u = second;
  march.attempt(0.05, 0.05, u);
  EXPECT_EQ(products, 4);
}

TEST(simplified_newton, factorizes_once_for_each_coefficient) {
  long values = 0, products = 0;
  newton_problem problem(no_transport{}, robertson{&values, &products});
  problem.with_tolerances(tolerances);
  const row begin{0.5, 3.9e-6, 0.4999961};  // on the slow manifold
  problem.begin_step(0, begin);
  int factorizations = 0;
  for (const double a : {1e-1, 1e-1, 5e-2, 1e-1, 5e-2}) {
    row u = begin;
    problem.solve_collision(a, a, 0.0, u);
    factorizations += problem.report().factorizations;
  }
  problem.end_step();
  EXPECT_EQ(factorizations, 2);
  EXPECT_EQ(products, 3);
}

TEST(simplified_newton, stages_are_roots_to_a_hundredth_of_the_tolerance) {
  check_property("roots of one stage, far from where the derivative was taken too", [] {
    long values = 0, products = 0;
    newton_problem exact(no_transport{}, robertson{&values, &products}),
        kept(no_transport{}, robertson{&values, &products});
    kept.with_tolerances(tolerances);
    const double y1 = magnitude(-7, -5), y2 = uniform(0.2, 0.9), a = magnitude(-4, 2);
    const row begin{1 - y1 - y2, y1, y2};
    row v = begin, w;
    v[0] -= 0.1 * begin[0], v[2] += 0.1 * begin[0];
    w = v;
    kept.begin_step(0, begin);
    kept.solve_collision(a, a, 0.0, w);
    kept.end_step();
    exact.solve_collision(a, a, 0.0, v);
    // The share is a thousandth, and the estimate of the error may be wrong by some factor. In 0.1 % of 20
    // 000 such stages the difference exceeds the share.
    for (std::size_t i = 0; i < 3; ++i)
      RC_ASSERT(std::abs(v[i] - w[i]) <= 1e-2 * (1e-6 * std::abs(v[i]) + tolerances.absolute(i)));
  });
}

TEST(simplified_newton, conserves_sums) {
  long values = 0, products = 0;
  newton_problem problem(no_transport{}, robertson{&values, &products});
  const component_tolerances<double> wide({1e-2}, {1e-6, 1e-10, 1e-6});
  problem.with_tolerances(wide, 1.0);
  for (const std::string name : {"extrapolated-euler-5", "ark-548"}) {
    apsis::evolution march(apsis::find_method(name), problem, apsis::step_rule<double>::unlimited(),
                           apsis::step_tolerance<row, double>{1.0, wide});
    march.start(0, {1, 0, 0});
    march.advance(1e6);
    // The tolerance covers the rounding of some hundred steps and the factor Σ|w| = 300 of extrapolation.
    EXPECT_NEAR(march.u()[0] + march.u()[1] + march.u()[2], 1, 1e-12) << name;
    EXPECT_GT(march.steps(), 10) << name;
  }
}

TEST(simplified_newton, a_step_depends_on_its_beginning_alone) {
  // A new problem repeats the steps of a run in another order. It has solved nothing before.
  for (const bool sparse : {false, true})
    for (const std::string name : {"extrapolated-euler-5", "ark-436", "dirk-4-3"}) {
      long values = 0, products = 0;
      const auto make = [&] {
        newton_problem problem(no_transport{}, robertson{&values, &products});
        problem.with_tolerances(tolerances);
        if (sparse) problem.with_sparsity(sparsity_pattern::banded(3, 2, 2));
        return problem;
      };
      auto problem = make();
      const apsis::step_tolerance<row, double> tolerance{1.0, tolerances};
      const auto unlimited = apsis::step_rule<double>::unlimited();
      apsis::evolution march(apsis::find_method(name), problem, unlimited, tolerance);
      struct step {
        double t0;
        row before;
        double t;
        row after;
      };
      std::vector<step> steps;
      row before{1, 0, 0};
      march.start(0, before);
      march.advance(40, [&](long, double t, double, const row& u) {
        steps.push_back({march.begin_of_step(), before, t, u});
        before = u;
        return true;
      });
      ASSERT_GT(steps.size(), 10u);
      std::reverse(steps.begin(), steps.end());
      for (const auto& one : steps) {
        auto untouched = make();
        apsis::evolution again(apsis::find_method(name), untouched, unlimited, tolerance);
        const double inside = 0.5 * (one.t0 + one.t);
        const row half = march.step_from(one.t0, one.before, inside);
        EXPECT_EQ(half, again.step_from(one.t0, one.before, inside)) << name << " " << one.t;
      }
    }
}

TEST(simplified_newton, full_band_and_sparse_matrices_solve_the_same_systems) {
  check_property("random bands, which need pivots", [] {
    constexpr std::size_t n = 40, lower = 2, upper = 1;
    row entries(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i < lower ? 0 : i - lower; j < std::min(n, i + upper + 1); ++j)
        entries[i * n + j] = (uniform(-1, 1) < 0 ? -1 : 1) * magnitude(-2, 2);
    long products = 0;
    const auto linear = [&](const auto& u, auto& out) {
      if constexpr (!std::is_same_v<std::decay_t<decltype(out[0])>, double>) ++products;
      for (std::size_t i = 0; i < n; ++i) {
        out[i] = 1.0 + 0.0 * u[i];
        for (std::size_t j = i < lower ? 0 : i - lower; j < std::min(n, i + upper + 1); ++j)
          out[i] += entries[i * n + j] * u[j];
      }
    };
    std::vector<sparsity_pattern::place> places{{0, n - 1}, {n - 1, 0}};  // a band as wide as the matrix
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i < lower ? 0 : i - lower; j < std::min(n, i + upper + 1); ++j)
        places.emplace_back(i, j);
    const auto band = sparsity_pattern::banded(n, lower, upper);
    const sparsity_pattern corners(n, places);
    const double a = magnitude(-2, 2);
    for (const sparsity_pattern* pattern : {static_cast<const sparsity_pattern*>(nullptr), &band, &corners}) {
      newton_problem problem(no_transport{}, linear);
      problem.with_tolerances({1e-6, 1e-6});
      if (pattern != nullptr) problem.with_sparsity(*pattern);
      products = 0;
      const row start(n, 1.0);
      row v = start;
      problem.begin_step(0, start);
      problem.solve_collision(a, a, 0.0, v);
      problem.end_step();
      RC_ASSERT(products == static_cast<long>(pattern != nullptr ? pattern->groups().size() : n));
      // Gaussian elimination is backward stable, so the residual is some roundings of its terms.
      for (std::size_t i = 0; i < n; ++i) {
        double rest = v[i] - 1 - a, terms = std::abs(v[i]) + 1 + a;
        for (std::size_t j = 0; j < n; ++j) {
          rest -= a * entries[i * n + j] * v[j];
          for (const double x : v) terms = std::max(terms, a * std::abs(entries[i * n + j] * x));
        }
        RC_ASSERT(std::abs(rest) <= 1e-11 * terms);
      }
    }
  });
}

TEST(simplified_newton, iterates_stay_in_the_admissible_set) {
  // √u has no value below 0. A full correction would lead there.
  std::set<double> seen;
  const auto roots = [&](const auto& u, auto& out) {
    using std::sqrt;
    if constexpr (std::is_same_v<std::decay_t<decltype(out[0])>, double>) seen.insert(u[0]);
    out[0] = -100.0 * sqrt(u[0]);
  };
  newton_problem problem(no_transport{}, roots);
  problem.with_tolerances({1e-6, 1e-10}).with_admissible([](std::span<const double> u) { return u[0] >= 0; });
  problem.begin_step(0, {1});
  row u{0.5};
  problem.solve_collision(0.1, 0.1, 0.0, u);
  problem.end_step();
  EXPECT_GE(*seen.begin(), 0);
  // The stage is v + 10 √v = 1/2.
  EXPECT_NEAR(std::sqrt(u[0]), std::sqrt(25.5) - 5, 1e-8);
}

TEST(simplified_newton, hands_what_it_cannot_solve_to_the_guarded_method) {
  // From u = 10 the corrections of e^u with the derivative at −10 overshoot. Those at later iterates
  // overshoot too.
  const auto explosive = [](const auto& u, auto& out) {
    using std::exp;
    out[0] = -1.0 * exp(u[0]);
  };
  newton_problem problem(no_transport{}, explosive), exact(no_transport{}, explosive);
  problem.with_tolerances({1e-8, 1e-8});
  problem.begin_step(0, {-10});
  row u{30}, v{30};
  problem.solve_collision(1, 1e3, 0.0, u);
  problem.end_step();
  exact.solve_collision(1, 1e3, 0.0, v);
  EXPECT_NEAR(u[0], v[0], 1e-10);
  EXPECT_EQ(problem.report().iterations, problem.report().factorizations);  // that of the guarded method
}

TEST(simplified_newton, without_tolerances_every_iteration_takes_a_derivative) {
  long values = 0, products = 0;
  newton_problem problem(no_transport{}, robertson{&values, &products});
  problem.begin_step(0, {1, 0, 0});
  row u{1, 0, 0};
  problem.solve_collision(1, 1.0, 0.0, u);
  problem.end_step();
  EXPECT_EQ(products, 3 * problem.report().iterations);
}

TEST(simplified_newton, stages_outside_of_a_step_do_not_depend_on_steps) {
  long values = 0, products = 0;
  newton_problem used(no_transport{}, robertson{&values, &products}),
      fresh(no_transport{}, robertson{&values, &products});
  used.with_tolerances(tolerances);
  fresh.with_tolerances(tolerances);
  used.begin_step(0, {0.5, 1e-5, 0.5});
  row u{0.4, 1e-5, 0.6}, v{1, 0, 0}, w{1, 0, 0};
  used.solve_collision(1, 1.0, 0.0, u);
  used.end_step();
  used.solve_collision(1, 0.1, 0.0, v);
  fresh.solve_collision(1, 0.1, 0.0, w);
  EXPECT_EQ(v, w);
}

TEST(simplified_newton, takes_the_derivative_at_the_time_of_the_beginning) {
  // u' = −(1 + t)² u. With the derivative at another time, the first step of a run would depend on earlier
  // calls. The solution is exp(−((1 + t)³ − 1)/3).
  const auto decay = [](const auto& t, const auto& u, auto& out) {
    out[0] = -1.0 * (1.0 + t) * (1.0 + t) * u[0];
  };
  newton_problem problem(no_transport{}, decay);
  const component_tolerances<double> fine(1e-8, 1e-10);
  problem.with_tolerances(fine);
  apsis::evolution march(apsis::find_method("extrapolated-euler-6"), problem,
                         apsis::step_rule<double>::unlimited(),
                         apsis::step_tolerance<row, double>{1.0, fine});
  march.start(0, {1});
  march.advance(1);
  EXPECT_NEAR(march.u()[0], std::exp(-7.0 / 3), 1e-7);  // ten tolerances of a step
}

}  // namespace
}  // namespace simplified_newton_test
