// Anderson's mixture on iterations whose fixed points are known.
#include <apsis/steady/anderson.hpp>

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <support/property.hpp>

namespace anderson_test {
namespace {

using apsis::field;

constexpr int n = 4;

/// x ← A x + b on one cell.
struct linear_map {
  double a[n][n], b[n];

  field image(const field& x) const {
    field g(1, n);
    for (int i = 0; i < n; ++i) {
      g.row(0)[i] = b[i];
      for (int j = 0; j < n; ++j) g.row(0)[i] += a[i][j] * x.row(0)[j];
    }
    return g;
  }
  double residual(const field& x) const {
    const field g = image(x);
    double largest = 0.0;
    for (int i = 0; i < n; ++i) largest = std::max(largest, std::abs(g.row(0)[i] - x.row(0)[i]));
    return largest;
  }
};

double iterate(const linear_map& map, int depth, int iterations) {
  apsis::anderson mixture(depth);
  field x(1, n);
  for (int k = 0; k < iterations; ++k) {
    field g = map.image(x);
    std::vector<double> r(n);
    for (int i = 0; i < n; ++i) r[static_cast<std::size_t>(i)] = g.row(0)[i] - x.row(0)[i];
    mixture.mix(*apsis::single_process(), r, g);
    x = g;
  }
  return map.residual(x);
}

linear_map random_map() {
  linear_map map{};
  for (int i = 0; i < n; ++i) {
    map.b[i] = *rc::gen::inRange(-100, 101) / 100.0;
    for (int j = 0; j < n; ++j) map.a[i][j] = *rc::gen::inRange(-100, 101) / 450.0;
  }
  return map;
}

}  // namespace

TEST(anderson, solves_linear_equations_in_as_many_steps_as_krylov_methods) {
  // With all images it is equivalent to GMRES (Walker & Ni, 2011), which ends after n steps; one more gives
  // the image. The tolerance allows for nearly parallel differences.
  check_property("n + 1 steps", [] {
    const linear_map map = random_map();
    RC_ASSERT(iterate(map, n, n + 2) < 1e-7);
  });
}

TEST(anderson, finds_fixed_points_from_which_the_iteration_itself_runs_away) {
  linear_map map{};
  for (int i = 0; i < n; ++i) {
    map.a[i][i] = 1.5 + 0.5 * i;
    map.b[i] = 1.0;
  }
  EXPECT_GT(iterate(map, 0, 8), 1e2);
  EXPECT_LT(iterate(map, n, 8), 1e-10);
}

TEST(anderson, without_images_or_after_forgetting_them_changes_nothing) {
  apsis::anderson none(0), some(3);
  field g(1, n);
  for (int i = 0; i < n; ++i) g.row(0)[i] = i;
  const std::vector<double> r(n, 1.0);
  none.mix(*apsis::single_process(), r, g);
  none.mix(*apsis::single_process(), std::vector<double>(n, 2.0), g);
  some.mix(*apsis::single_process(), r, g);
  some.clear();
  some.mix(*apsis::single_process(), std::vector<double>(n, 2.0), g);
  for (int i = 0; i < n; ++i) EXPECT_EQ(g.row(0)[i], i);
}

}  // namespace anderson_test
