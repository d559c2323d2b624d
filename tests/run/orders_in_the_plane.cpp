// Observed orders in time of gases in the plane. The reference has the same mesh, so the error in space
// cancels. Edge values are linear functions of the state. On a coarse mesh WENO weights change so fast in
// time that these steps are not yet in the asymptotic range.
#include <apsis/config/case.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace orders_in_the_plane_test {

namespace {

const char* const gas = R"toml(
[model]
name = "bgk"
degrees_of_freedom = 3
[initial]
rho = "1 + 0.2*sin(2*pi*x)*cos(2*pi*y)"
u = ["0.3*sin(2*pi*(x + y))", "0.2*cos(2*pi*x)"]
T = "1 + 0.1*cos(2*pi*(x - y))"
[space]
cells = [10, 8]
domain = [[0, 1], [0, 1]]
limiter = "none"
reconstruction = "upwind5"
[velocity]
max = 6.5
points = 14
[time]
method = "md-imex-6-3"
end = 0.05
dt = 0.0001
)toml";

std::vector<double> state_after(const std::string& method, const std::string& epsilon, int steps) {
  apsis::simulation run(apsis::parse_case(
      gas, "gas.toml",
      {"time.method=" + method, "model.epsilon=" + epsilon, fmt::format("time.dt={}", 0.05 / steps)}));
  while (!run.finished()) run.advance();
  EXPECT_EQ(run.step(), steps);
  return run.state();
}

double mean_distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += std::abs(a[k] - b[k]);
  return sum / static_cast<double>(a.size());
}

}  // namespace

TEST(orders_in_the_plane, are_those_of_the_method_in_time_at_large_and_vanishing_epsilon) {
  for (const std::string epsilon : {"1", "1e-12"}) {
    // The reference is of order 4. Its steps are a quarter of the shortest ones.
    const auto reference = state_after("md-imex-14-4-accurate", epsilon, 64);
    for (const auto& [method, order] : {std::pair{"md-imex-3-2", 2.0},
                                        {"md-imex-6-2-mixed", 2.0},
                                        {"md-imex-6-3", 3.0},
                                        {"md-imex-8-3-mixed", 3.0}}) {
      const double coarse = mean_distance(state_after(method, epsilon, 8), reference),
                   fine = mean_distance(state_after(method, epsilon, 16), reference);
      RecordProperty(fmt::format("{}_at_{}", method, epsilon),
                     fmt::format("{:.3f}", std::log2(coarse / fine)));
      // The next term of the error is at most a hundredth of the first.
      EXPECT_NEAR(std::log2(coarse / fine), order, 0.02) << method << " " << epsilon << " " << fine;
    }
  }
}

}  // namespace orders_in_the_plane_test
