// Anderson's mixture on iterations whose fixed points are known.
#include <apsis/steady/anderson.hpp>

#include <algorithm>
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
    const field g = map.image(x);
    std::vector<double> r(n);
    for (int i = 0; i < n; ++i) r[static_cast<std::size_t>(i)] = g.row(0)[i] - x.row(0)[i];
    field delta(1, n);
    std::copy_n(r.begin(), n, delta.row(0));
    mixture.move(mixture.weigh(*apsis::single_process(), r, {}), delta, 1.0, x);
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
  // With all images the mixture is equivalent to GMRES (Walker & Ni, 2011), which ends after n steps. One
  // more step gives the image. The tolerance allows for nearly parallel differences.
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

TEST(anderson, without_images_or_after_forgetting_them_moves_to_the_image) {
  apsis::anderson none(0), some(3);
  const auto move = [](apsis::anderson& mixture, double r, field& x) {
    field delta(1, n);
    for (int i = 0; i < n; ++i) delta.row(0)[i] = r;
    const auto weights = mixture.weigh(*apsis::single_process(), std::vector<double>(n, r), {7.0});
    EXPECT_EQ(weights.of_mixture, std::vector{7.0});
    mixture.move(weights, delta, 1.0, x);
  };
  field x(1, n), y(1, n);
  move(none, 1.0, x);
  move(none, 2.0, x);
  move(some, 1.0, y);
  some.clear();
  move(some, 2.0, y);
  for (int i = 0; i < n; ++i) EXPECT_EQ(x.row(0)[i], 3.0);
  for (int i = 0; i < n; ++i) EXPECT_EQ(y.row(0)[i], 3.0);
}

TEST(anderson, knows_linear_functions_of_the_mixture_and_scales_it) {
  check_property("total", [] {
    const linear_map map = random_map();
    apsis::anderson mixture(2);
    field x(1, n);
    const auto total = [](const field& of) {
      double sum = 0.0;
      for (int i = 0; i < n; ++i) sum += of.row(0)[i];
      return sum;
    };
    double size = 0.0;  // sum over all images
    for (int k = 0; k < 6; ++k) {
      const field g = map.image(x);
      field delta(1, n);
      std::vector<double> r(n);
      for (int i = 0; i < n; ++i) {
        r[static_cast<std::size_t>(i)] = delta.row(0)[i] = g.row(0)[i] - x.row(0)[i];
        size += std::abs(g.row(0)[i]);
      }
      const auto weights = mixture.weigh(*apsis::single_process(), r, {total(g)});
      double amplified = 1.0;
      for (const double theta : weights.theta) amplified += std::abs(theta);
      const double factor = k < 5 ? 1.0 : 0.5;
      mixture.move(weights, delta, factor, x);
      // The weights amplify the rounding of the sums.
      RC_ASSERT(std::abs(total(x) - factor * weights.of_mixture[0]) <= 1e-14 * amplified * (1.0 + size));
    }
  });
}

}  // namespace anderson_test
