// The cost of f ≥ 0. Profiles in free flight touch zero or fall by many powers of ten. Limited and unlimited
// fluxes take the same steps (docs/measured.md, "Limiters").
#include "laws.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace limited_free_flight_test {

namespace {

/// Velocities along x. Nothing changes along y, where cells are long.
constexpr std::array<double, 4> velocities = {1.0, 0.5, -1.0, -0.5};

struct profile {
  std::string formula;
  std::function<double(double)> at;
};

const profile gaussian = {"exp(-200*(x - 0.5)^2)",
                          [](double x) { return std::exp(-200 * std::pow(x - 0.5, 2)); }},
              fourth_power = {"sin(pi*x)^4",
                              [](double x) { return std::pow(std::sin(std::numbers::pi * x), 4); }},
              square = {"sin(pi*x)^2", [](double x) { return std::pow(std::sin(std::numbers::pi * x), 2); }},
              box = {"abs(x - 0.5) < 0.25 ? 1 : 0",
                     [](double x) { return std::abs(x - 0.5) < 0.25 ? 1.0 : 0.0; }};

struct flight {
  double fastest,  ///< mean error of the molecules with v = 1
      slower,      ///< mean error of the molecules with v = 1/2
      least;       ///< smallest value of f in all steps
};

/// Runs one transit of molecules with v = 1 on n cells.
flight fly(const profile& of, int n, double safety, const std::string& limiter) {
  std::string initial;
  for (int j = 1; j <= 4; ++j) initial += fmt::format("f_{} = \"{}\"\n", j, of.formula);
  const auto run = finished_run(
      "[model]\nname = \"discrete-velocity\"\nepsilon = 1e12\nvelocities = [[1, 0.5], [0.5, -1], [-1, -0.5], "
      "[-0.5, "
      "1]]\n"
      "collisions = [[1, 3, 2, 4]]\n[initial]\n" +
          initial +
          "[space]\ndomain = [[0, 1], [0, 10]]\n[time]\nmethod = "
          "\"md-imex-6-3\"\nend = 1\n",
      {fmt::format("space.cells=[{},5]", n), fmt::format("time.safety={}", safety),
       "space.limiter=" + limiter});
  const auto f = run.state();
  std::array<double, 4> errors{};
  for (int cell = 0; cell < 5 * n; ++cell)
    for (std::size_t j = 0; j < 4; ++j) {
      const double origin = run.mesh().centre(cell)[0] - velocities[j];
      errors[j] +=
          std::abs(f[static_cast<std::size_t>(cell) * 4 + j] - of.at(origin - std::floor(origin))) / (5 * n);
    }
  return {errors[0], errors[1], run.summary().min_value};
}

void expect_cost(const std::string& name, const profile& of, int n, double safety, double most) {
  const flight limited = fly(of, n, safety, "positivity"), free = fly(of, n, safety, "none");
  const std::string what = fmt::format("{} on {} cells, safety {}: {:.3g} limited, {:.3g} without", name, n,
                                       safety, limited.fastest, free.fastest);
  ::testing::Test::RecordProperty(fmt::format("{}_{}_{}", name, n, safety), what);
  EXPECT_GE(limited.least, 0.0) << what;
  EXPECT_LE(limited.fastest, most * free.fastest) << what;
  EXPECT_LE(limited.slower, most * free.slower) << what;
}

}  // namespace

/// In the longest step the fastest molecules leave 0.9 of a cell. Where the limiter acts, it damps. Errors
/// are then 0.39 to 1.00 times those without it, and up to 1.12 times for sin⁴.
void expect_costs(int n, double safety) {
  expect_cost("gaussian", gaussian, n, safety, 1.01);
  expect_cost("box", box, n, safety, 1.01);
  expect_cost("fourth_power", fourth_power, n, safety, 1.25);
}

TEST(limited_free_flight, costs_no_accuracy_but_where_f_touches_zero_like_a_parabola) {
  for (const double safety : {1.0, 0.5}) expect_costs(40, safety);
  expect_costs(80, 1.0);
  // There an exact forward Euler step is negative by the square of its length. The error is 4.3, 5.2, 6.2
  // times as large for |v| = 1, and 9 to 14 times for 1/2.
  for (const int n : {40, 80}) expect_cost("square", square, n, 1.0, 25.0);
}

TEST(SLOW_limited_free_flight, costs_no_accuracy_on_fine_meshes_and_in_short_steps) {
  for (const int n : {80, 160})
    for (const double safety : {1.0, 0.5, 0.1}) expect_costs(n, safety);
  expect_cost("square", square, 160, 1.0, 25.0);
  expect_cost("square", square, 160, 0.1, 70.0);  // 34 and 27 times as large as a smaller error
}

TEST(limited_free_flight, without_the_limiter_becomes_negative) {
  for (const profile& of : {gaussian, fourth_power, box})
    EXPECT_LT(fly(of, 40, 1.0, "none").least, 0.0) << of.formula;
}

TEST(limited_free_flight, keeps_third_order_where_the_solution_touches_zero) {
  // With Δt ~ Δx the order is that of the method in time.
  const double coarse = fly(square, 80, 1.0, "positivity").fastest,
               fine = fly(square, 160, 1.0, "positivity").fastest;
  EXPECT_GT(std::log2(coarse / fine), 2.6);
}

}  // namespace limited_free_flight_test
