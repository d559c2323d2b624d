// Four states at rest meet in a corner. Away from it the flow along every side of the domain is that of a
// shock tube. Its exact solution is known in the limit ε → 0.
#include "laws.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include <gtest/gtest.h>
#include <support/shock_tube.hpp>

namespace riemann_in_the_plane_test {

namespace {

struct state {
  double rho, p;
};
/// The states below left, below right, above left and above right.
constexpr std::array<state, 4> corners = {{{1.0, 1.0}, {0.5, 0.4}, {0.6, 0.5}, {0.3, 0.15}}};

const char* const four_states = R"toml(
[model]
name = "bgk"
epsilon = 0
[initial]
rho = "x < 0.5 ? (y < 0.5 ? 1 : 0.6) : (y < 0.5 ? 0.5 : 0.3)"
u = [0, 0]
T = "x < 0.5 ? (y < 0.5 ? 1 : 0.5/0.6) : (y < 0.5 ? 0.8 : 0.5)"
[space]
domain = [[0, 1], [0, 1]]
boundary = "symmetry"
[velocity]
max = 6
points = 16
[time]
method = "md-imex-3-2"
end = 0.12
cfl = 0.8
)toml";

/// Returns the L1 errors of the density in the cells along the lower, upper, left and right side.
std::array<double, 4> errors_along_sides(int n) {
  const auto run = finished_run(four_states, {fmt::format("space.cells=[{0},{0}]", n)});
  const auto fields = run.fields();
  constexpr double gamma = 2.0;  // two degrees of freedom
  std::array<double, 4> errors{};
  const std::array<std::array<std::size_t, 2>, 4> pairs = {{{0, 1}, {2, 3}, {0, 2}, {1, 3}}};
  for (std::size_t side = 0; side < 4; ++side) {
    const state &high = corners[pairs[side][0]], &low = corners[pairs[side][1]];
    const test_support::shock_tube exact(gamma, high.rho, high.p, low.rho, low.p);
    const int last = n - 1;
    for (int k = 0; k < n; ++k) {
      const int cell = side == 0 ? k * n : side == 1 ? k * n + last : side == 2 ? k : last * n + k;
      errors[side] += std::abs(fields.values[0][static_cast<std::size_t>(cell)] -
                               exact.density(((k + 0.5) / n - 0.5) / run.t())) /
                      n;
    }
  }
  return errors;
}

void expect_shock_tubes(int n) {
  const auto coarse = errors_along_sides(n), fine = errors_along_sides(2 * n);
  double all_coarse = 0.0, all_fine = 0.0;
  for (std::size_t side = 0; side < 4; ++side) {
    testing::Test::RecordProperty(fmt::format("side_{}", side),
                                  fmt::format("{:.4f} {:.4f}", coarse[side], fine[side]));
    // Shocks and contacts are smeared over a few cells. Contacts narrow more slowly than cells.
    EXPECT_GT(std::log2(coarse[side] / fine[side]), 0.5) << side << ": " << coarse[side] << " " << fine[side];
    all_coarse += coarse[side];
    all_fine += fine[side];
  }
  EXPECT_GT(std::log2(all_coarse / all_fine), 0.8);
  EXPECT_LT(all_fine,
            4.0 * 0.4 / (2 * n));  // 0.4 of a cell along each side; states differ by 0.2 to 0.5
}

}  // namespace

TEST(riemann_in_the_plane, has_the_exact_shock_tubes_along_its_sides) {
  expect_shock_tubes(16);
}

TEST(SLOW_riemann_in_the_plane, has_the_exact_shock_tubes_along_its_sides) {
  expect_shock_tubes(40);
}

}  // namespace riemann_in_the_plane_test
