// Gases at ε = 0 in the plane agree with the limit scheme written out by hand on the same mesh.
#include "plane_euler_limit.hpp"

#include <apsis/config/case.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace euler_limit_in_the_plane_test {

namespace {

using moments = plane_euler_limit::moments;

const char* const gas = R"toml(
[model]
name = "bgk"
[initial]
rho = "1 + 0.2*sin(2*pi*x)*cos(2*pi*y/0.8)"
u = ["0.3*sin(2*pi*(x + y/0.8))", "0.2*cos(2*pi*x)"]
T = "1 + 0.1*cos(2*pi*(x - y/0.8))"
[space]
limiter = "none"
cells = [9, 7]
domain = [[0, 1], [0, 0.8]]
[velocity]
max = 9.6
points = 28
[time]
end = 0.015
dt = 0.003
)toml";

moments initial(double x, double y, int degrees) {
  using std::numbers::pi;
  const double rho = 1.0 + 0.2 * std::sin(2.0 * pi * x) * std::cos(2.0 * pi * y / 0.8),
               ux = 0.3 * std::sin(2.0 * pi * (x + y / 0.8)), uy = 0.2 * std::cos(2.0 * pi * x),
               T = 1.0 + 0.1 * std::cos(2.0 * pi * (x - y / 0.8));
  return {rho, rho * ux, rho * uy, 0.5 * rho * (ux * ux + uy * uy + degrees * T)};
}

/// Returns the moments of a run by plain sums.
std::vector<moments> moments_of(const apsis::simulation& run) {
  const auto v = run.setup().equation->velocities();
  const auto points = static_cast<std::size_t>(v.size());
  std::vector<moments> all;
  for (int cell = 0; cell < run.mesh().size(); ++cell) {
    const auto row = run.row(cell);
    moments sum{};
    for (std::size_t j = 0; j < points; ++j) {
      const double vx = v.speeds(0)[j], vy = v.speeds(1)[j], h = row.size() > points ? row[points + j] : 0.0;
      const double mass = v.weights()[j] * row[j];
      sum[0] += mass;
      sum[1] += mass * vx;
      sum[2] += mass * vy;
      sum[3] += 0.5 * (mass * (vx * vx + vy * vy) + v.weights()[j] * h);
    }
    all.push_back(sum);
  }
  return all;
}

/// Returns the largest distance of the moments at t = 0.015, after five steps.
double distance(const std::string& method, int degrees, const std::string& epsilon) {
  apsis::simulation run(
      apsis::parse_case(gas, "gas.toml",
                        {"time.method=" + method, fmt::format("model.degrees_of_freedom={}", degrees),
                         "model.epsilon=" + epsilon}));
  plane_euler_limit limit({9, 7, 1.0 / 9, 0.8 / 7, 9.6, 28, degrees},
                          [&](double x, double y) { return initial(x, y, degrees); });
  const auto form = apsis::find_method(method).coefficients<double>();
  while (!run.finished()) {
    run.advance();
    limit.step(form, 0.003);
  }
  const auto found = moments_of(run);
  double largest = 0.0;
  for (std::size_t c = 0; c < found.size(); ++c)
    for (std::size_t k = 0; k < 4; ++k)
      largest = std::max(largest, std::abs(found[c][k] - limit.omega[c][k]));
  return largest;
}

}  // namespace

TEST(euler_limit_in_the_plane, is_the_limit_scheme_written_out_by_hand) {
  for (const std::string method : {"md-imex-3-2", "md-imex-6-3"})
    for (const int degrees : {2, 3}) {
      const double found = distance(method, degrees, "0");
      RecordProperty(fmt::format("{}_{}", method, degrees), fmt::format("{:.2g}", found));
      // The moments are up to 5, and are rounded in five steps. The steps change them by 0.1.
      EXPECT_LT(found, 2e-14) << method << " " << degrees;
    }
}

TEST(euler_limit_in_the_plane, is_approached_in_proportion_to_epsilon) {
  // The method has the viscosity of the equation. In steps beyond ε the terms of size ε of
  // md-imex-3-2 would vanish.
  const std::string method = "md-imex-8-3-mixed";
  const double coarse = distance(method, 2, "1e-6"), fine = distance(method, 2, "1e-7");
  EXPECT_NEAR(coarse / fine, 10.0, 0.1);
  EXPECT_LT(fine, 1e-6);
}

}  // namespace euler_limit_in_the_plane_test
