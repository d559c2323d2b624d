// Specular reflection at walls with any normal: fluxes, signs, Maxwellians, mirrored components.
#include <apsis/boundary/oblique_reflection.hpp>

#include "boundary/oblique_rows.hpp"

#include <apsis/boundary/mirrored_components.hpp>
#include <apsis/core/errors.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <support/bad_input.hpp>

namespace oblique_reflection_test {
namespace {

using namespace oblique_rows;
using apsis::oblique_reflection;

/// Returns the mean error of reflecting f over some normals, relative to the flux of mass.
double error_of(const std::string& kind, int points,
                const std::function<double(const vector& v, const vector& n, const vector& t)>& f) {
  const velocity_set set = grid_of(2, kind, points, 7.0, 1);
  const oblique_reflection wall(set);
  double wrong = 0.0, all = 0.0;
  for (int k = 0; k < 12; ++k) {
    const double angle = 0.1 + 0.5 * k;
    const vector n = {std::cos(angle), std::sin(angle), 0.0}, t = {-n[1], n[0], 0.0};
    const auto inward = inward_of(set, n);
    const auto arriving = row_of(set, [&](const vector& v) { return f(v, n, t); });
    std::vector<double> made(arriving.size());
    EXPECT_TRUE(wall.reflect(n, inward.data(), arriving.data(), made.data()).is_matched);
    for (std::size_t j = 0; j < made.size(); ++j) {
      if (!(inward[j] > 0.0)) continue;
      const vector v = velocity_of(set, j);
      const double flux = set.weights()[j] * inward[j],
                   exact = f({v[0] - 2 * inward[j] * n[0], v[1] - 2 * inward[j] * n[1], 0.0}, n, t);
      wrong += flux * std::abs(made[j] - exact);
      all += flux * exact;
    }
  }
  return wrong / all;
}

}  // namespace

RC_GTEST_PROP(oblique_reflection, what_leaves_has_the_fluxes_of_what_arrives_and_is_nonnegative, ()) {
  const int d = *rc::gen::inRange(2, 4), sets = *rc::gen::inRange(1, 3);
  const auto kind = *rc::gen::element(row_kind::positive, row_kind::decades, row_kind::few);
  const velocity_set set = grid_of(d, *rc::gen::element<std::string>("uniform", "graded", "gauss-hermite"),
                                   d == 2 ? 14 : 8, 6.0, sets);
  std::mt19937 generator(*rc::gen::arbitrary<unsigned>());
  const vector n = random_normal(d, generator);
  const auto inward = inward_of(set, n);
  const auto f = random_row(kind, at(set.components()), generator);
  std::vector<double> made(f.size(), std::numeric_limits<double>::quiet_NaN());
  const auto report = oblique_reflection(set).reflect(n, inward.data(), f.data(), made.data());
  for (std::size_t k = 0; k < f.size(); ++k) RC_ASSERT(!(inward[k] > 0.0) || made[k] >= 0.0);
  // Newton's method matches sums of at most 512 numbers up to their rounding errors.
  const double error = difference(fluxes_of(set, n, inward, -1.0, f), fluxes_of(set, n, inward, 1.0, made),
                                  !report.is_matched);
  RC_ASSERT(error <= 1e-14);
  RC_ASSERT(report.is_matched || kind != row_kind::positive);
  RC_CLASSIFY(report.is_matched, "matched");
}

TEST(oblique_reflection, matches_nearly_all_rows_and_the_mass_of_others) {
  std::mt19937 generator(1);
  int matched = 0, runs = 0;
  for (const std::string kind : {"uniform", "graded"})
    for (const int d : {2, 3}) {
      const velocity_set set = grid_of(d, kind, d == 2 ? 16 : 10, 6.0, 1);
      const oblique_reflection wall(set);
      for (int k = 0; k < 50; ++k) {
        const vector n = random_normal(d, generator);
        const auto inward = inward_of(set, n);
        const auto f = random_row(row_kind::decades, at(set.components()), generator);
        std::vector<double> made(f.size());
        matched += wall.reflect(n, inward.data(), f.data(), made.data()).is_matched ? 1 : 0;
        ++runs;
      }
    }
  EXPECT_GE(matched, 0.98 * runs);
}

TEST(oblique_reflection, gives_the_mass_of_a_single_component) {
  std::mt19937 generator(2);
  const velocity_set set = grid_of(2, "uniform", 8, 4.0, 2);
  const oblique_reflection wall(set);
  int unmatched = 0;
  for (std::size_t one = 0; one < at(set.components()); ++one) {
    const vector n = random_normal(2, generator);
    const auto inward = inward_of(set, n);
    std::vector<double> f(at(set.components())), made = f;
    f[one] = 3.0;
    unmatched += wall.reflect(n, inward.data(), f.data(), made.data()).is_matched ? 0 : 1;
    const auto a = fluxes_of(set, n, inward, -1.0, f), b = fluxes_of(set, n, inward, 1.0, made);
    EXPECT_NEAR(static_cast<double>(a.sum[0]), static_cast<double>(b.sum[0]),
                1e-14 * static_cast<double>(a.sum[0]));
    EXPECT_NEAR(static_cast<double>(a.sum[5]), static_cast<double>(b.sum[5]),
                1e-14 * static_cast<double>(a.sum[5]));
  }
  EXPECT_GT(unmatched, 10);
}

TEST(oblique_reflection, of_nothing_is_nothing_and_of_nan_is_nan) {
  const velocity_set set = grid_of(2, "uniform", 8, 4.0, 2);
  const vector n = {0.6, 0.8, 0.0};
  const auto inward = inward_of(set, n);
  std::vector<double> f(at(set.components())), made(f.size(), 7.0);
  EXPECT_TRUE(oblique_reflection(set).reflect(n, inward.data(), f.data(), made.data()).is_matched);
  for (std::size_t k = 0; k < f.size(); ++k) EXPECT_TRUE(!(inward[k] > 0.0) || made[k] == 0.0);
  std::fill(f.begin(), f.end(), 1.0);
  f[at(static_cast<int>(std::min_element(inward.begin(), inward.end()) - inward.begin()))] =
      std::numeric_limits<double>::quiet_NaN();
  oblique_reflection(set).reflect(n, inward.data(), f.data(), made.data());
  bool is_nan = false;
  for (std::size_t k = 0; k < f.size(); ++k) is_nan = is_nan || (inward[k] > 0.0 && std::isnan(made[k]));
  EXPECT_TRUE(is_nan);
}

TEST(oblique_reflection, does_not_depend_on_the_unit_of_the_distribution) {
  std::mt19937 generator(3);
  const velocity_set set = grid_of(2, "graded", 12, 5.0, 2);
  const oblique_reflection wall(set);
  const vector n = {0.28, -0.96, 0.0};
  const auto inward = inward_of(set, n);
  const auto f = random_row(row_kind::positive, at(set.components()), generator);
  std::vector<double> made(f.size()), scaled = f, of_scaled(f.size());
  wall.reflect(n, inward.data(), f.data(), made.data());
  for (const int exponent : {-1000, -300, 300, 900}) {
    for (std::size_t k = 0; k < f.size(); ++k) scaled[k] = std::ldexp(f[k], exponent);
    wall.reflect(n, inward.data(), scaled.data(), of_scaled.data());
    for (std::size_t k = 0; k < f.size(); ++k)
      if (inward[k] > 0.0) {
        EXPECT_EQ(of_scaled[k], std::ldexp(made[k], exponent));
      }
  }
}

TEST(oblique_reflection, reflects_negative_values_with_their_fluxes) {
  std::mt19937 generator(4);
  std::uniform_real_distribution<double> number(-1.0, 2.0);
  for (const int d : {2, 3}) {
    const velocity_set set = grid_of(d, "uniform", 8, 5.0, 2);
    const vector n = random_normal(d, generator);
    const auto inward = inward_of(set, n);
    std::vector<double> f(at(set.components())), made(f.size());
    for (double& one : f) one = number(generator);
    EXPECT_TRUE(oblique_reflection(set).reflect(n, inward.data(), f.data(), made.data()).is_matched);
    EXPECT_LT(difference(fluxes_of(set, n, inward, -1.0, f), fluxes_of(set, n, inward, 1.0, made), false),
              1e-14);
  }
}

RC_GTEST_PROP(oblique_reflection, of_a_maxwellian_at_rest_is_this_maxwellian, ()) {
  const int d = *rc::gen::inRange(2, 4);
  const velocity_set set =
      grid_of(d, *rc::gen::element<std::string>("uniform", "graded"), d == 2 ? 24 : 12, 6.0, 2);
  const double T = *rc::gen::inRange(40, 200) / 100.0;
  std::mt19937 generator(*rc::gen::arbitrary<unsigned>());
  const vector n = random_normal(d, generator);
  const auto inward = inward_of(set, n);
  const auto f = row_of(set, [&](const vector& v) { return maxwellian(v, {}, T); });
  std::vector<double> made(f.size());
  RC_ASSERT(oblique_reflection(set).reflect(n, inward.data(), f.data(), made.data()).is_matched);
  // The Maxwellian has exponents of at most 140. Its multipliers are accurate to some units of rounding.
  for (std::size_t k = 0; k < f.size(); ++k)
    RC_ASSERT(!(inward[k] > 0.0) || std::abs(made[k] - f[k]) <= 1e-14 + 1e-12 * f[k]);
}

TEST(oblique_reflection, of_moving_maxwellians_is_accurate) {
  const auto moving = [](double along, double towards) {
    return [=](const vector& v, const vector& n, const vector& t) {
      return maxwellian(v, {along * t[0] - towards * n[0], along * t[1] - towards * n[1], 0.0}, 1.0);
    };
  };
  for (const std::string kind : {"uniform", "graded"}) {
    // For gas that moves along the wall the fluxes agree up to the error of sums over all velocities.
    EXPECT_LT(error_of(kind, 32, moving(1.0, 0.0)), 1e-7) << kind;
    // For gas that moves towards the wall, sums over half of the velocities have order 3 here.
    const double coarse = error_of(kind, 16, moving(0.8, 0.5)), fine = error_of(kind, 32, moving(0.8, 0.5));
    EXPECT_LT(coarse, 2e-3) << kind;
    EXPECT_GT(std::log2(coarse / fine), 2.8) << kind;
  }
  // For a mixture of two gases the interpolation is of second order.
  const auto both = [&](const vector& v, const vector& n, const vector& t) {
    return moving(0.8, 0.5)(v, n, t) + 0.5 * maxwellian(v, {0.3 * n[0] - t[0], 0.3 * n[1] - t[1], 0.0}, 0.5);
  };
  const double coarse = error_of("uniform", 24, both), fine = error_of("uniform", 48, both);
  EXPECT_LT(coarse, 1e-2);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.3);
}

TEST(oblique_reflection, at_normals_along_axes_gives_mirrored_components) {
  std::mt19937 generator(5);
  for (const std::string kind : {"uniform", "graded", "gauss-hermite"})
    for (const int d : {2, 3})
      for (int k = 0; k < d; ++k)
        for (const double sign : {-1.0, 1.0}) {
          const velocity_set set = grid_of(d, kind, 8, 5.0, 2);
          vector n{};
          n[at(k)] = sign;
          const auto inward = inward_of(set, n);
          const auto f = random_row(row_kind::decades, at(set.components()), generator);
          std::vector<double> made(f.size());
          const auto report = oblique_reflection(set).reflect(n, inward.data(), f.data(), made.data());
          EXPECT_EQ(report.passes, 0);
          const auto images = apsis::mirrored_components(set, k);
          for (std::size_t j = 0; j < f.size(); ++j)
            if (inward[j] > 0.0) {
              EXPECT_EQ(made[j], f[at(images[j])]);
            }
        }
}

TEST(oblique_reflection, near_an_axis_is_near_the_mirrored_components) {
  const velocity_set set = grid_of(2, "uniform", 16, 5.0, 1);
  const oblique_reflection wall(set);
  const auto f = row_of(set, [](const vector& v) {
    return maxwellian(v, {-0.5, 0.4, 0.0}, 1.0) + 0.3 * maxwellian(v, {1.0, -0.7, 0.0}, 0.6);
  });
  const vector axis = {1.0, 0.0, 0.0}, near = {std::cos(1e-6), std::sin(1e-6), 0.0};
  std::vector<double> exact(f.size()), made(f.size());
  wall.reflect(axis, inward_of(set, axis).data(), f.data(), exact.data());
  wall.reflect(near, inward_of(set, near).data(), f.data(), made.data());
  const auto inward = inward_of(set, axis);
  for (std::size_t k = 0; k < f.size(); ++k)
    if (inward[k] > 0.0) {
      EXPECT_NEAR(made[k], exact[k], 1e-5);
    }
}

TEST(oblique_reflection, refuses_velocities_between_which_it_cannot_interpolate) {
  const velocity_set scattered({{1.0, -1.0, 0.0, 0.0}, {0.0, 0.0, 1.0, -1.0}}, {1.0, 1.0, 1.0, 1.0});
  bad_input::expect_refused({
      {[&] { oblique_reflection{scattered}; }, {"not all combinations"}},
      {[&] { oblique_reflection{grid_of(2, "uniform", 4, 1.0, 3)}; }, {"3 sets of components"}},
  });
}

}  // namespace oblique_reflection_test
