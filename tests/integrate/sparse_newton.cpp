// Sparse derivatives: groups of columns. Sparse and dense systems have the same stages.
#include <apsis/integrate/difference_derivatives.hpp>
#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/newton_problem.hpp>
#include <apsis/integrate/sparsity_pattern.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <integrate/random.hpp>
#include <support/bad_input.hpp>
#include <support/property.hpp>

namespace sparse_newton_test {
namespace {

using apsis::newton_problem;
using apsis::no_transport;
using apsis::sparsity_pattern;
using random_input::magnitude;
using random_input::one_in;
using random_input::uniform;
using row = std::vector<double>;

/// Requires that every column is in one group and that columns of a group share no row.
void require_valid_groups(const sparsity_pattern& pattern) {
  std::size_t columns = 0;
  std::set<std::size_t> all;
  for (const auto& group : pattern.groups()) {
    std::set<std::size_t> rows;
    std::size_t entries = 0;
    for (const std::size_t j : group) {
      all.insert(j);
      rows.insert(pattern.rows(j).begin(), pattern.rows(j).end());
      entries += pattern.rows(j).size();
    }
    RC_ASSERT(rows.size() == entries);
    columns += group.size();
  }
  RC_ASSERT(columns == pattern.size() && all.size() == pattern.size());
}

TEST(sparsity_pattern, groups_of_columns_share_no_row) {
  check_property("random places", [] {
    const auto n = static_cast<std::size_t>(uniform(1, 40));
    std::vector<sparsity_pattern::place> places;
    const auto count = static_cast<std::size_t>(uniform(0, 100));
    const auto below_n = [n] {
      return std::min(n - 1, static_cast<std::size_t>(uniform(0, static_cast<double>(n))));
    };
    for (std::size_t k = 0; k < count; ++k) places.emplace_back(below_n(), below_n());
    const sparsity_pattern pattern(n, places);
    require_valid_groups(pattern);
    for (const auto& [i, j] : places) {
      const auto rows = pattern.rows(j);
      RC_ASSERT(std::binary_search(rows.begin(), rows.end(), i) &&
                std::binary_search(rows.begin(), rows.end(), i));
    }
    for (std::size_t j = 0; j < n; ++j) {
      const auto rows = pattern.rows(j);
      RC_ASSERT(std::binary_search(rows.begin(), rows.end(), j));  // the diagonal
    }
  });
}

TEST(sparsity_pattern, of_a_band_has_as_many_groups_as_diagonals) {
  for (const std::size_t lower : {0u, 1u, 3u})
    for (const std::size_t upper : {0u, 2u, 5u}) {
      const auto pattern = sparsity_pattern::banded(20, lower, upper);
      EXPECT_EQ(pattern.groups().size(), lower + upper + 1);
      require_valid_groups(pattern);
      EXPECT_EQ(pattern.entries(),
                20 * (lower + upper + 1) - lower * (lower + 1) / 2 - upper * (upper + 1) / 2);
    }
}

TEST(sparsity_pattern, refuses_places_outside) {
  bad_input::expect_refused({
      {[] { sparsity_pattern(0, {}); }, {"no unknowns"}, 2},
      {[] { sparsity_pattern(3, {{0, 3}}); }, {"place (0, 3)", "3 unknowns"}, 2},
      {[] {
         newton_problem problem(no_transport{}, [](const auto& u, auto& out) { out[0] = -1.0 * u[0]; });
         problem.with_sparsity(sparsity_pattern::banded(2, 1, 1));
         row u{1};
         problem.solve_collision(0, 1, 0, u);
       },
       {"pattern has 2 unknowns and the state 1"},
       2},
  });
}

/// Diffusion with a cubic reaction on a ring. The last unknown depends on the first, so the pattern is
/// not a band.
struct ring {
  double spread, fast;
  template <class U, class V>
  void operator()(const U& u, V& out) const {
    const std::size_t n = u.size();
    for (std::size_t i = 0; i < n; ++i) {
      const auto &left = u[(i + n - 1) % n], &right = u[(i + 1) % n];
      out[i] = spread * (left - 2.0 * u[i] + right) - fast * (u[i] * u[i] * u[i] - u[i]);
    }
  }
  static sparsity_pattern pattern(std::size_t n) {
    std::vector<sparsity_pattern::place> places;
    for (std::size_t i = 0; i < n; ++i)
      for (const std::size_t j : {(i + n - 1) % n, i, (i + 1) % n}) places.emplace_back(i, j);
    return {n, places};
  }
};

TEST(sparse_newton, solves_the_stages_of_dense_systems) {
  check_property("random stage of a ring of 3 to 30 unknowns", [] {
    const auto n = static_cast<std::size_t>(uniform(3, 31));
    const double a = magnitude(-4, 0) * 0.5, b = one_in(3) ? 0.0 : -a * a * uniform(0.1, 1);
    // The diffusion is arbitrary. The reaction changes the derivative of the stage little, so a root exists.
    const double spread = magnitude(-2, 3);
    const ring g{spread, uniform(0.01, 0.1) / (a * (1 + 72 * a * spread))};
    newton_problem dense(no_transport{}, g), sparse(no_transport{}, g);
    sparse.with_sparsity(ring::pattern(n));
    row u(n);
    for (double& x : u) x = uniform(0.5, 2);
    row v = u, w = u;
    dense.solve_collision(0, a, b, v);
    sparse.solve_collision(0, a, b, w);
    // Both solutions are roots up to rounding errors. Δt λ ≤ 5e3 multiplies these errors.
    for (std::size_t i = 0; i < n; ++i) RC_ASSERT(std::abs(v[i] - w[i]) <= 1e-11);
  });
}

TEST(sparse_newton, keeps_slow_directions_of_stiff_systems) {
  // A ring without reaction conserves its mean. Differences decay 1e12 times as fast as the step.
  const std::size_t n = 40;
  for (const double b : {0.0, -0.125}) {
    newton_problem problem(no_transport{}, ring{1e12, 0.0});
    problem.with_sparsity(ring::pattern(n));
    row u(n);
    double mean = 0;
    for (std::size_t i = 0; i < n; ++i) mean += u[i] = 1 + std::sin(static_cast<double>(i * i));
    mean /= static_cast<double>(n);
    problem.solve_collision(0, 0.5, b, u);
    // The tolerance is Δt λ times rounding, 1e12 · 1e-16 · √n.
    for (const double x : u) EXPECT_NEAR(x, mean, 1e-3) << b;
    double after = 0;
    for (const double x : u) after += x / static_cast<double>(n);
    EXPECT_NEAR(after, mean, 1e-3) << b;
  }
}

TEST(sparse_newton, refuses_singular_stages) {
  // u' = (u₁, −u₀) has the eigenvalues ±i, so the stage with a = 0 and b = −1 is singular.
  newton_problem problem(no_transport{}, [](const auto& u, auto& out) {
    out[0] = u[1];
    out[1] = -1.0 * u[0];
  });
  problem.with_sparsity(sparsity_pattern::banded(2, 1, 1));
  row u{1, 0};
  bad_input::expect_refused(
      {{[&] { problem.solve_collision(0, 0, -1, u); }, {"singular to working precision"}, 3}});
}

/// A right-hand side for doubles only, like existing code of users. Its unknowns have sizes 1 and 1e-6, and
/// it depends on time.
void reaction(double t, std::span<const double> u, std::span<double> out) {
  for (std::size_t i = 0; i < u.size(); i += 2) {
    const double next = i + 2 < u.size() ? u[i + 2] : 1 + 0.1 * std::sin(t);
    const double fast = 1e6 * (u[i] * u[i] - 1e6 * u[i + 1]);
    out[i] = next - u[i] - 1e-6 * fast;
    out[i + 1] = 1e-6 * fast;
  }
}

TEST(difference_derivatives, agree_with_derivatives_by_hand) {
  apsis::difference_derivatives g(reaction);
  g.set_time(0.7);
  const row u{1.2, 1.3e-6, 0.8, 0.7e-6}, x{0.5, 2e-7, -0.25, 1e-6}, k{1, -1e-6, 0.5, 2e-6};
  row jx(4), hx(4), gt(4);
  g.jacobian_product(u, x, jx);
  g.curvature(u, k, x, hx);
  g.time_derivative(u, gt);
  for (std::size_t i = 0; i < 4; i += 2) {
    const double fast = 2 * u[i] * x[i] - 1e6 * x[i + 1];
    EXPECT_NEAR(jx[i], (i == 0 ? x[2] : 0) - x[i] - fast, 1e-8);  // two thirds of the digits
    EXPECT_NEAR(jx[i + 1], fast, 1e-8);
    EXPECT_NEAR(hx[i + 1], 2 * k[i] * x[i], 1e-5);  // half of the digits
    EXPECT_NEAR(gt[i + 1], 0, 1e-8);
  }
  EXPECT_NEAR(gt[2], 0.1 * std::cos(0.7), 1e-8);
}

TEST(difference_derivatives, solve_stiff_systems_by_one_difference_for_each_group) {
  // Ten pairs with the rate 1e6. A difference approximates the derivatives of each group.
  const std::size_t n = 20;
  long calls = 0;
  const auto counted = [&calls](double t, std::span<const double> u, std::span<double> out) {
    ++calls;
    reaction(t, u, out);
  };
  newton_problem problem(no_transport{}, apsis::difference_derivatives(counted));
  const apsis::component_tolerances<double> tolerances(1e-6, 1e-12);
  problem.with_tolerances(tolerances).with_sparsity(sparsity_pattern::banded(n, 1, 2));
  const apsis::method& m = apsis::find_method("extrapolated-euler-4");
  apsis::stepper march(m, problem, apsis::solutions::result_and_embedded);
  apsis::step_controller<double> control(1.0, apsis::estimate_of(m).order);
  row u(n);
  for (std::size_t i = 0; i < n; i += 2) u[i] = 1, u[i + 1] = 1e-6;
  const auto done = apsis::integrate_to_tolerance(march, u, 0.0, 1.0, apsis::step_rule<double>::unlimited(),
                                                  control, tolerances);
  // The solution is near the slow manifold u₁ = 1e-6 u₀², up to rates of size 1/1e6. The sum of the last pair
  // follows its own equation, up to 1e-6: y' (1 + 2e-6 y) = 1 + 0.1 sin t − y with y(0) = 1.
  for (std::size_t i = 0; i < n; i += 2) EXPECT_NEAR(u[i + 1] * 1e6, u[i] * u[i], 1e-5);
  EXPECT_NEAR(u[n - 2], 1 + 0.05 * (std::sin(1.0) - std::cos(1.0) + std::exp(-1.0)), 1e-5);
  // A step has 10 solves with some iterations. Each of four groups needs two differences. This is far below
  // two differences for each of 20 unknowns.
  EXPECT_LT(calls / done.steps, 10 * 3 * (2 * 4 + 4));
}

TEST(sparse_newton, a_copy_of_a_problem_has_factorizations_of_its_own) {
  newton_problem one(no_transport{}, ring{3, 1});
  one.with_sparsity(ring::pattern(8));
  row u(8, 0.5), v(8, 0.5);
  u[0] = v[0] = 1;
  one.solve_collision(0, 0.1, -0.01, u);
  auto two = one;
  two.solve_collision(0, 0.1, -0.01, v);
  EXPECT_EQ(u, v);
}

TEST(sparse_newton, takes_thousands_of_unknowns) {
  // A dense system of (v, k) with 2000 unknowns would take 6e10 operations, and there are hundreds. The heat
  // equation on a ring reduces its first mode by exp(−λ) with λ = 4 spread sin²(π/n).
  const std::size_t n = 2000;
  const double wave = 2 * std::acos(-1.0) / static_cast<double>(n), spread = 1 / (wave * wave);
  newton_problem problem(no_transport{}, ring{spread, 0.0});
  problem.with_sparsity(ring::pattern(n)).with_tolerances({1e-6, 1e-6});
  const apsis::method& m = apsis::find_method("imdrk-3-3");
  apsis::stepper march(m, problem, apsis::solutions::result_and_embedded);
  apsis::step_controller<double> control(1.0, apsis::estimate_of(m).order);
  row u(n);
  for (std::size_t i = 0; i < n; ++i) u[i] = std::sin(wave * static_cast<double>(i));
  apsis::integrate_to_tolerance(march, u, 0.0, 1.0, apsis::step_rule<double>::unlimited(), control,
                                apsis::component_tolerances(1e-6, 1e-6));
  const double half = std::sin(wave / 2), rate = 4 * spread * half * half;
  EXPECT_NEAR(u[n / 4], std::exp(-rate), 1e-5);  // 10 tolerances
}

}  // namespace
}  // namespace sparse_newton_test
