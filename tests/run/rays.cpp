// Rays of discrete velocities in a square of walls with two temperatures, without collisions. The gas is at
// rest. Walls with densities proportional to 1/sqrt(T) emit the same flux in every direction. The momentum of
// the exact solution therefore vanishes everywhere.
#include <apsis/config/case.hpp>
#include <apsis/model/velocity_rays.hpp>
#include <apsis/run/simulation.hpp>
#include <apsis/velocity/velocity_line_registry.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rays_test {

namespace {

using apsis::velocity_line;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using overrides = std::vector<std::string>;

const std::string square = R"toml(
title = "Square"
[model]
name = "bgk"
epsilon = 1e4
[initial]
rho = 1
T = 1
[space]
cells = [20, 20]
boundary = "diffuse"
reconstruction = "upwind5"
[boundary.top]
kind = "diffuse"
T = 1.2
[velocity]
set = "graded"
max = 6.5
points = 16
[time]
method = "ssprk-3-3"
safety = 0.9
end = 5
)toml";

velocity_line line(const std::string& set, int points, double max) {
  return apsis::find_velocity_line(set).make(points, max);
}

double ray_error(const std::string& set, int points, double max) {
  return apsis::ray_error(line(set, points, max), line(set, points, max), 1.0);
}

std::string words_of(const overrides& changes) {
  testing::internal::CaptureStderr();
  const apsis::simulation run(apsis::parse_case(square, "square.toml", changes));
  return testing::internal::GetCapturedStderr();
}

}  // namespace

TEST(ray_error, falls_with_the_number_of_velocities) {
  // The error falls about as the number of directions of a line to the power 3/2, because sums over
  // directions are not equally spaced.
  for (const char* set : {"uniform", "graded"})
    for (const int n : {16, 24, 40}) {
      const double order = std::log2(ray_error(set, n, 6.5) / ray_error(set, 2 * n, 6.5));
      EXPECT_GT(order, 1.0) << set << ' ' << n;
      EXPECT_LT(order, 2.0) << set << ' ' << n;
    }
}

TEST(ray_error, is_that_of_a_sum_over_sectors) {
  // The expected error sorts all velocities by their angle. Its angles lie between those of the function.
  const velocity_line of = line("graded", 32, 6.5);
  const double pi = std::acos(-1.0);
  double total = 0.0;
  constexpr int angles = 5000;
  for (int k = 0; k < angles; ++k) {
    const double angle = (k + 0.5) * pi / (2.0 * angles);
    double x = 0.0, y = 0.0;
    for (int i = 16; i < 32; ++i)
      for (int j = 16; j < 32; ++j) {
        const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
        const double v = of.v()[a], w = of.v()[b];
        if (std::atan2(w, v) > angle) continue;
        const double weight =
            of.weights()[a] * of.weights()[b] * std::exp(-0.5 * (v * v + w * w)) / (2.0 * pi);
        x += weight * v;
        y += weight * w;
      }
    const double exact = std::sqrt(pi / 2.0) / (2.0 * pi);
    total += std::pow(x - exact * std::sin(angle), 2) + std::pow(y - exact * (1.0 - std::cos(angle)), 2);
  }
  EXPECT_NEAR(ray_error("graded", 32, 6.5), std::sqrt(total / angles), 0.05 * std::sqrt(total / angles));
}

TEST(rays, of_a_free_molecular_square_are_as_large_as_announced) {
  apsis::simulation run(apsis::parse_case(square, "square.toml"));
  while (!run.finished()) run.advance();
  const auto fields = run.fields();
  double sum = 0.0;
  ASSERT_EQ(fields.names[1], "u_x");
  const auto &u = fields.values[1], &v = fields.values[2];
  for (std::size_t cell = 0; cell < u.size(); ++cell) sum += u[cell] * u[cell] + v[cell] * v[cell];
  const double noise = std::sqrt(sum / static_cast<double>(u.size()));
  // The largest jump is that of √T log T. The mesh smooths the rays.
  const double announced = ray_error("graded", 16, 6.5) * std::log(1.2);
  EXPECT_GT(noise, 0.2 * announced);
  EXPECT_LT(noise, 1.2 * announced);
}

TEST(rays, are_announced_before_a_run_with_more_velocities) {
  const std::string words = words_of({});
  EXPECT_THAT(
      words,
      AllOf(HasSubstr("(few velocity directions and few collisions)"),
            HasSubstr(fmt::format("{:.1g} % of the largest jump", 100.0 * ray_error("graded", 16, 6.5))),
            HasSubstr("velocity.points = [32, 32] reduce it to")));
}

TEST(rays, are_not_announced_where_there_are_none) {
  const auto silent = Not(HasSubstr("rays"));
  EXPECT_THAT(words_of({"boundary.top.T=1"}), silent);    // all walls emit the same gas
  EXPECT_THAT(words_of({"model.epsilon=0.01"}), silent);  // collisions remove the jump
  EXPECT_THAT(words_of({"velocity.points=80"}), silent);  // enough velocity directions
}

}  // namespace rays_test
