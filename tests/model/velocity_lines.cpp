// Velocity lines: quadrature, discrete conservation and refusals. The table of docs/velocities.md uses the
// case gas/couette.
#include "support/folder.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/random_source.hpp>
#include <apsis/model/maxwellian.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/velocity/gauss_rule.hpp>
#include <apsis/velocity/velocity_line_registry.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <support/bad_input.hpp>

namespace velocity_lines_test {

namespace {

using apsis::find_velocity_line;
using apsis::make_lines;
using apsis::velocity_config;
using apsis::velocity_grid;
using apsis::velocity_line;
using testing::HasSubstr;

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const auto* entry : apsis::velocity_line_entries()) all.push_back(entry->name);
  return all;
}

template <class Function>
double integral(const velocity_line& line, const Function& f) {
  double sum = 0.0;
  for (std::size_t j = 0; j < line.v().size(); ++j) sum += line.weights()[j] * f(line.v()[j]);
  return sum;
}

double gaussian(double v) {
  return std::exp(-0.5 * v * v) / std::sqrt(2.0 * std::numbers::pi);
}

velocity_config config_of(std::vector<std::string> set, apsis::point_counts points, double max = 6.0) {
  velocity_config of;
  of.set = std::move(set);
  of.points = std::move(points);
  of.max = max;
  return of;
}

/// Returns random rows f ≥ 0. Some have few values, and values have any size.
std::vector<double> random_row(int size) {
  std::vector<double> f(static_cast<std::size_t>(size));
  const int kind = *rc::gen::inRange(0, 3);
  for (double& one : f) {
    const bool zero = kind == 1 && *rc::gen::inRange(0, 10) > 0;
    const double decades = kind == 2 ? *rc::gen::inRange(-20, 1) : 0.0;
    one = zero ? 0.0 : std::pow(10.0, decades) * (*rc::gen::inRange(0, 1000) / 999.0);
  }
  return f;
}

}  // namespace

TEST(velocity_line, integrates_maxwellians) {
  // The moments of a Gaussian of temperature 1 up to the fourth are 1, 0, 1, 0, 3. Its mass beyond
  // 8 is 1e-15.
  for (const auto& name : names()) {
    const velocity_line line = find_velocity_line(name).make(40, 8.0);
    const double exact[] = {1.0, 0.0, 1.0, 0.0, 3.0};
    for (int k = 0; k < 5; ++k)
      EXPECT_NEAR(integral(line, [k](double v) { return std::pow(v, k) * gaussian(v); }), exact[k], 2e-6)
          << name << " " << k;
  }
}

TEST(velocity_line, for_walls_integrates_halves_of_maxwellians) {
  // ∫_0^∞ v M dv = 1/√(2π) and ∫_0^∞ v² M dv = ½. A uniform set with 0 between its points has
  // an error Δv²/24.
  const auto half = [](const velocity_line& line, int power) {
    return integral(line, [power](double v) { return v > 0.0 ? std::pow(v, power) * gaussian(v) : 0.0; });
  };
  const double flux = 1.0 / std::sqrt(2.0 * std::numbers::pi);
  EXPECT_GT(std::abs(half(find_velocity_line("uniform").make(32, 8.0), 1) - flux), 2e-3);
  for (const char* name : {"graded", "half-range-gauss-hermite"}) {
    const velocity_line line = find_velocity_line(name).make(32, name[0] == 'g' ? 8.0 : 0.0);
    EXPECT_NEAR(half(line, 0), 0.5, 1e-6) << name;
    EXPECT_NEAR(half(line, 1), flux, 1e-6) << name;
    EXPECT_NEAR(half(line, 2), 0.5, 1e-6) << name;
  }
}

TEST(velocity_line, graded_has_sixth_order_for_a_jump_at_0) {
  const auto error = [](int points) {
    const velocity_line line = find_velocity_line("graded").make(points, 9.0);
    return std::abs(integral(line, [](double v) { return v > 0.0 ? std::exp(-v) * gaussian(v) : 0.0; }) -
                    0.5 * std::exp(0.5) * std::erfc(1.0 / std::numbers::sqrt2));
  };
  EXPECT_NEAR(std::log2(error(24) / error(48)), 6.0, 0.7);
}

TEST(gauss_rule, is_exact_for_polynomials_times_the_weight) {
  // ∫ x^{2k} e^{−x²/2} = √(2π) (2k − 1)!!. On x > 0 the even powers have half of this, and ∫ x^k e^{−x²/2} =
  // 2^{(k−1)/2} Γ((k+1)/2).
  for (const int n : {4, 9, 30}) {
    const auto whole = apsis::gauss_hermite(n), half = apsis::half_range_gauss_hermite(n);
    for (int k = 0; k < std::min(2 * n, 24); ++k) {
      const double exact = std::pow(2.0, 0.5 * (k - 1)) * std::tgamma(0.5 * (k + 1));
      double of_whole = 0.0, of_half = 0.0;
      for (std::size_t j = 0; j < whole.nodes.size(); ++j) {
        of_whole +=
            whole.weights[j] * std::pow(whole.nodes[j], k) * std::exp(-0.5 * whole.nodes[j] * whole.nodes[j]);
        of_half +=
            half.weights[j] * std::pow(half.nodes[j], k) * std::exp(-0.5 * half.nodes[j] * half.nodes[j]);
      }
      EXPECT_NEAR(of_whole, k % 2 == 0 ? 2.0 * exact : 0.0, 1e-11 * exact) << n << " " << k;
      EXPECT_NEAR(of_half, exact, 1e-11 * exact) << n << " " << k;
    }
  }
}

RC_GTEST_PROP(velocity_grid, every_row_has_a_maxwellian_with_its_moments_on_every_set, ()) {
  const int d = *rc::gen::inRange(1, 4);
  std::vector<std::string> set;
  std::vector<int> points;
  for (int k = 0; k < d; ++k) {
    set.push_back(*rc::gen::elementOf(names()));
    points.push_back(2 * *rc::gen::inRange(2, d == 1 ? 20 : 5));
  }
  const velocity_grid grid(make_lines(config_of(set, points), d));
  const std::vector<double> f = random_row(grid.size());
  std::vector<double> m(f.size());
  std::array<double, 5> omega{}, own{};
  kinetic_moments(grid, f.data(), omega.data());
  RC_ASSERT(discrete_maxwellian(grid, omega.data(), m.data()));
  RC_ASSERT(*std::min_element(m.begin(), m.end()) >= 0.0);
  kinetic_moments(grid, m.data(), own.data());
  // The tolerance is relative to the largest terms of the sums. Newton's method ends at the rounding of sums
  // over the grid.
  const double speed = grid.max(), rho = omega[0], tolerance = 1e-12;
  RC_ASSERT(std::abs(own[0] - rho) <= tolerance * rho);
  for (std::size_t k = 1; k <= static_cast<std::size_t>(d); ++k)
    RC_ASSERT(std::abs(own[k] - omega[k]) <= tolerance * rho * speed);
  RC_ASSERT(std::abs(own[static_cast<std::size_t>(d) + 1] - omega[static_cast<std::size_t>(d) + 1]) <=
            tolerance * rho * speed * speed * d);
}

TEST(velocity_grid, weights_sum_any_function_as_lines_do) {
  const velocity_grid grid(make_lines(config_of({"graded", "gauss-hermite"}, std::vector<int>{8, 6}), 2));
  ASSERT_EQ(grid.size(), 48);
  const auto weights = grid.set().weights();
  double sum = 0.0, product = 0.0;
  for (std::size_t j = 0; j < weights.size(); ++j) sum += weights[j] * grid.half_square()[j];
  const auto one = [](double) { return 1.0; };
  const auto half_square = [](double v) { return 0.5 * v * v; };
  product = integral(grid.line(0), half_square) * integral(grid.line(1), one) +
            integral(grid.line(0), one) * integral(grid.line(1), half_square);
  EXPECT_NEAR(sum, product, 1e-12 * product);
}

TEST(velocity_line, is_read_from_a_file) {
  const test_folder folder;
  const auto path = folder / "v.csv";
  const auto read = [&](const std::string& text) {
    std::ofstream(path) << text;
    static_cast<void>(apsis::read_velocity_line(path));
  };
  EXPECT_NO_THROW(read("v,w\n# four\n-2, 1\n-1, 0.5\r\n1 0.5\n2;1\n"));
  const velocity_line line = apsis::read_velocity_line(path);
  EXPECT_EQ(std::vector<double>(line.v().begin(), line.v().end()), (std::vector<double>{-2, -1, 1, 2}));
  EXPECT_EQ(line.weights()[2], 0.5);
  bad_input::expect_refused({
      {[&] { read("v,w\n-2,1\n-1,x\n1,1\n2,1\n"); }, {"v.csv:3: not a velocity and its weight"}},
      {[&] { read("-2,1\n-1,1,4\n1,1\n2,1\n"); }, {"v.csv:2: not a velocity and its weight"}},
      {[&] { read("-2,1\n-1,1\n"); }, {"2 velocity points (too few"}},
      {[&] { read("-2,1\n2,1\n1,1\n3,1\n"); }, {"velocity 3 is 1 (velocities are finite and increase)"}},
      {[&] { read("-2,1\n-1,0\n1,1\n2,1\n"); }, {"the weight of velocity -1 is 0"}},
      {[&] { read("-2,1\n-1,nan\n1,1\n2,1\n"); }, {"the weight of velocity -1 is nan"}},
      {[] { static_cast<void>(apsis::read_velocity_line("nothing.csv")); }, {"cannot read 'nothing.csv'"}, 4},
  });
}

TEST(velocity_line, refuses_what_it_cannot_be) {
  const auto make = [](const velocity_config& of, int d) { static_cast<void>(make_lines(of, d)); };
  bad_input::expect_refused({
      {[&] { make(config_of({"grade"}, 8), 1); },
       {"velocity.set = 'grade' is not known", "did you mean 'graded'"}},
      {[&] { make(config_of({"graded"}, 9), 1); }, {"it is odd"}},
      {[&] { make(config_of({"half-range-gauss-hermite"}, 9), 1); }, {"cannot be halved"}},
      {[&] { make(config_of({"gauss-hermite"}, 400), 1); }, {"4 to 300 are possible"}},
      {[&] { make(config_of({"uniform", "graded"}, 8), 3); }, {"velocity.set has 2 entries"}},
      {[&] { make(config_of({}, std::vector<int>{8, 8}), 3); }, {"velocity.points has 2 entries"}},
      {[&] { make(config_of({"graded"}, 8, 0.0), 1); }, {"velocity.max is missing"}},
  });
  EXPECT_NO_THROW(make(config_of({"gauss-hermite"}, 8, 0.0), 1));
}

TEST(velocity_set_of_a_gas, says_before_the_run_whether_it_holds_the_data) {
  const auto problem = [](const std::string& set, int points, double T) {
    auto parts = apsis::default_config(apsis::find_model("bgk"));
    parts.velocity = config_of({set}, points, set == "graded" ? 6.0 : 0.0);
    const auto gas = apsis::find_model("bgk").make(parts);
    std::vector<double> row(static_cast<std::size_t>(gas->components()));
    const auto form = gas->data_forms().front();
    if (!form.row(std::vector<double>{1.0, 0.0, T}, row).empty()) return std::string("no Maxwellian");
    return gas->check_supported(row.data()).problem;
  };
  EXPECT_EQ(problem("graded", 24, 1.0), "");
  EXPECT_THAT(problem("graded", 24, 6.0),
              HasSubstr("velocity.max is too small for the data (the 24 velocities"));
  EXPECT_EQ(problem("gauss-hermite", 12, 1.0), "");
  EXPECT_THAT(problem("gauss-hermite", 12, 0.2),
              HasSubstr("velocity.points is too small for the data (the 12 velocities"));
  EXPECT_EQ(problem("half-range-gauss-hermite", 16, 1.0), "");
}

}  // namespace velocity_lines_test
