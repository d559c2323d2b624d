// Gases in the plane and in space: embedded problems of fewer dimensions, symmetries, exact free flight,
// accuracy, and solid boxes.
#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace space_dimensions_test {

namespace {

using apsis::simulation;

const std::string gas_in_a_box = R"toml(
title = "Gas in a box"
[parameters]
L = 1
[model]
name = "bgk"
velocity_dimensions = 2
degrees_of_freedom = 3
epsilon = 0.05
[initial]
rho = "1 + 0.2*sin(2*pi*x)"
u = ["0.1*cos(2*pi*x)", 0.05]
T = "1 + 0.1*cos(2*pi*x)"
[space]
cells = [12]
domain = [[0, 1]]
formulation = "finite-difference"
limiter = "positivity"
[velocity]
max = 7.5
points = 12
[time]
method = "md-imex-6-3"
dt = 0.001
end = 0.01
)toml";

std::vector<double> result_of(const std::vector<std::string>& overrides) {
  simulation run(apsis::parse_case(gas_in_a_box, "box.toml", overrides));
  while (!run.finished()) run.advance();
  return run.state();
}

/// Returns the number of component (i, j) with its indices exchanged, for velocities on a 12 x 12 lattice
/// with two sets.
std::size_t exchanged(std::size_t k) {
  constexpr std::size_t n = 12;
  return k / (n * n) * n * n + k % n * n + k / n % n;
}

}  // namespace

TEST(space_dimensions, a_problem_on_a_line_is_the_same_along_x_in_the_plane_and_in_space) {
  // Differences along y and z are exactly 0, so all bits agree. There is no limiter, because the limiter of a
  // velocity depends on its motion along y too.
  const auto line = result_of({"space.limiter=none"});
  const auto plane = result_of({"space.cells=[12,7]", "space.domain=[[0,1],[0,2]]", "space.limiter=none"});
  const std::size_t row = line.size() / 12;
  for (std::size_t i = 0; i < 12; ++i)
    for (std::size_t j = 0; j < 7; ++j)
      for (std::size_t k = 0; k < row; ++k)
        ASSERT_EQ(plane[(i * 7 + j) * row + k], line[i * row + k]) << i << " " << j << " " << k;
}

TEST(space_dimensions, a_problem_on_a_line_is_the_same_along_y) {
  const auto line = result_of({});
  const auto plane =
      result_of({"space.cells=[7,12]", "space.domain=[[0,2],[0,1]]", "initial.rho=1 + 0.2*sin(2*pi*y)",
                 "initial.u=[0.05, \"0.1*cos(2*pi*y)\"]", "initial.T=1 + 0.1*cos(2*pi*y)"});
  const std::size_t row = line.size() / 12;
  double largest = 0.0;
  for (std::size_t i = 0; i < 7; ++i)
    for (std::size_t j = 0; j < 12; ++j)
      for (std::size_t k = 0; k < row; ++k)
        largest = std::max(largest, std::abs(plane[(i * 12 + j) * row + exchanged(k)] - line[j * row + k]));
  // Sums over velocities have another order. In 10 steps of 6 stages this gives some roundings of values up
  // to 0.2.
  EXPECT_LT(largest, 1e-14);
}

TEST(space_dimensions, three_velocity_dimensions_carry_a_line_along_each_axis) {
  const std::vector<std::string> common = {"model.velocity_dimensions=3", "velocity.points=10",
                                           "velocity.max=6.5", "time.end=0.003"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), common.begin(), common.end());
    return result_of(more);
  };
  const auto line = with({"initial.u=[\"0.1*cos(2*pi*x)\",0,0]"});
  constexpr std::size_t n = 10, row = n * n * n;
  for (const std::string axis : {"x", "y", "z"}) {
    const std::size_t k = axis == "x" ? 0 : axis == "y" ? 1 : 2;
    std::array<std::size_t, 3> cells = {7, 7, 7}, apart = {49, 7, 1};
    const std::string along = "cos(2*pi*" + axis + ")";
    std::array<std::string, 3> u = {"0", "0", "0"};
    u[k] = "0.1*" + along;
    std::array<int, 3> count = {7, 7, 7};
    count[k] = 12;
    cells[k] = 12;
    apart = {cells[1] * cells[2], cells[2], 1};
    const auto space = with({fmt::format("space.cells=[{},{},{}]", count[0], count[1], count[2]),
                             "space.domain=[[0,1],[0,1],[0,1]]", "initial.rho=1 + 0.2*sin(2*pi*" + axis + ")",
                             fmt::format("initial.u=[\"{}\",\"{}\",\"{}\"]", u[0], u[1], u[2]),
                             "initial.T=1 + 0.1*" + along});
    // The velocity indices (a, b, c) of the line, with a along x, correspond to those with a along the axis.
    const std::array<std::size_t, 3> strides = {n * n, n, 1};
    double largest = 0.0;
    for (std::size_t i = 0; i < 12; ++i)
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b)
          for (std::size_t c = 0; c < n; ++c) {
            const std::size_t there = a * strides[k] + b * strides[(k + 1) % 3] + c * strides[(k + 2) % 3];
            largest =
                std::max(largest, std::abs(space[(i * apart[k] + 2 * apart[(k + 1) % 3]) * row + there] -
                                           line[i * row + a * n * n + b * n + c]));
          }
    EXPECT_LT(largest, 1e-14) << axis;  // as above
  }
}

TEST(space_dimensions, a_rotation_by_a_right_angle_rotates_the_result) {
  const std::vector<std::string> plane = {"space.cells=[11,11]", "space.domain=[[-1,1],[-1,1]]"};
  auto one = plane, other = plane;
  one.insert(one.end(), {"initial.rho=1 + 0.5*exp(-8*((x - 0.3)^2 + (y + 0.1)^2))",
                         "initial.u=[\"0.3*y\",\"0.2*x\"]", "initial.T=1 + 0.2*sin(pi*x)"});
  // The rotation is counter-clockwise, (x, y) → (−y, x), so f'(x, y) = f(y, −x).
  other.insert(other.end(), {"initial.rho=1 + 0.5*exp(-8*((y - 0.3)^2 + (-x + 0.1)^2))",
                             "initial.u=[\"-0.2*y\",\"0.3*(-x)\"]", "initial.T=1 + 0.2*sin(pi*y)"});
  const auto a = result_of(one), b = result_of(other);
  const std::size_t n = 11, row = a.size() / (n * n), set = 144;
  double largest = 0.0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k < row; ++k) {
        const std::size_t vx = k % set / 12, vy = k % 12;
        // The cell (i, j) and the velocity (vx, vy) are mapped to (−j, i) and (−vy, vx).
        const std::size_t to = (n - 1 - j) * n + i, velocity = k / set * set + (11 - vy) * 12 + vx;
        largest = std::max(largest, std::abs(b[to * row + velocity] - a[(i * n + j) * row + k]));
      }
  // WENO weights divide by squares of differences. Their rounding errors have other signs after the rotation.
  EXPECT_LT(largest, 1e-13);
}

TEST(space_dimensions, waves_at_45_degrees_fly_freely_with_fifth_order) {
  const auto error = [](int n) {
    const double dt = 0.02 / std::pow(n / 12.0, 5.0 / 3.0);  // third order in time, as small as fifth order
    simulation run(
        apsis::parse_case(gas_in_a_box, "box.toml",
                          {fmt::format("space.cells=[{},{}]", n, n), "space.domain=[[0,1],[0,1]]",
                           "model.epsilon=1e12", "initial.rho=1 + 0.2*sin(2*pi*(x + y))", "initial.u=[0,0]",
                           "initial.T=1/4", "velocity.points=12", "velocity.max=3", "space.limiter=none",
                           "space.reconstruction=weno5-z", fmt::format("time.dt={}", dt), "time.end=0.1"}));
    while (!run.finished()) run.advance();
    const auto f = run.state();
    const std::size_t row = f.size() / static_cast<std::size_t>(n * n);
    const auto vx = run.setup().equation->velocities().speeds(0),
               vy = run.setup().equation->velocities().speeds(1);
    // The solution is f(t, x, v) = f(0, x − v t, v). f(0, ·, v) is ρ times a function of v alone.
    double sum = 0.0;
    std::vector<double> mean(row, 0.0);
    for (std::size_t c = 0; c < f.size(); ++c) mean[c % row] += f[c] / (1.0 * n * n);
    for (std::size_t c = 0; c < f.size(); ++c) {
      const std::size_t cell = c / row, k = c % row;
      const double x = (static_cast<double>(cell / static_cast<std::size_t>(n)) + 0.5) / n,
                   y = (static_cast<double>(cell % static_cast<std::size_t>(n)) + 0.5) / n;
      const double exact =
          mean[k] * (1.0 + 0.2 * std::sin(2.0 * std::numbers::pi * (x + y - 0.1 * (vx[k] + vy[k]))));
      sum += std::abs(f[c] - exact) / static_cast<double>(f.size());
    }
    return sum;
  };
  const double coarse = error(12), fine = error(24);
  EXPECT_GT(std::log2(coarse / fine), 4.8) << coarse << " " << fine;
}

namespace {

/// Returns overrides for 20 x 16 cells with two solid boxes, heated and moving walls.
std::vector<std::string> with_boxes(std::vector<std::string> more = {}) {
  std::vector<std::string> all = {"space.cells=[20,16]",
                                  "space.domain=[[0,1],[0,0.8]]",
                                  "space.boundary=diffuse",
                                  "boundary.top.velocity=[0.3,0]",
                                  "boundary.left.T=1.4 + 0.2*sin(40*t)*y",
                                  "space.solid.1.from=[0.3,0.2]",
                                  "space.solid.1.to=[0.5,0.45]",
                                  "space.solid.1.T=0.7",
                                  "space.solid.2.name=corner",
                                  "space.solid.2.from=[0.8,0]",
                                  "space.solid.2.to=[1,0.4]",
                                  "space.solid.2.kind=symmetry"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace

TEST(solids, a_box_over_the_lower_half_leaves_the_problem_above_it) {
  const auto above =
      result_of({"space.cells=[12,9]", "space.domain=[[0,1],[0.5,1]]", "space.boundary=periodic",
                 "boundary.bottom.kind=diffuse", "boundary.bottom.T=1.3", "boundary.top.kind=diffuse"});
  const auto whole =
      result_of({"space.cells=[12,18]", "space.domain=[[0,1],[0,1]]", "space.boundary=periodic",
                 "boundary.bottom.kind=diffuse", "boundary.top.kind=diffuse", "space.solid.1.from=[0,0]",
                 "space.solid.1.to=[1,0.5]", "space.solid.1.T=1.3"});
  const std::size_t row = above.size() / (12 * 9);
  double largest = 0.0;
  for (std::size_t i = 0; i < 12; ++i)
    for (std::size_t j = 0; j < 9; ++j)
      for (std::size_t k = 0; k < row; ++k) {
        largest =
            std::max(largest, std::abs(whole[(i * 18 + j + 9) * row + k] - above[(i * 9 + j) * row + k]));
        EXPECT_EQ(whole[(i * 18 + j) * row + k], 0.0);  // zero in solid cells
      }
  EXPECT_LT(largest, 1e-15);  // coordinates differ by rounding
}

TEST(solids, keep_the_gas_nonnegative_and_close_every_balance_to_rounding) {
  for (const std::string epsilon : {"0", "1e-6", "1e-2", "1e12"}) {
    simulation run(apsis::parse_case(
        gas_in_a_box, "box.toml",
        with_boxes({"model.epsilon=" + epsilon, "time.safety=1", "initial.rho=x + y < 0.4 ? 1 : 1e-9",
                    "initial.u=[0,0]", "initial.T=1", "time.end=0.03"})));
    EXPECT_TRUE(run.promises().positivity);
    EXPECT_TRUE(run.promises().conservation);
    while (!run.finished()) run.advance();
    EXPECT_EQ(run.summary().negative_values, 0) << epsilon;
    // About 20 steps of 6 stages with 2e5 unknowns each.
    EXPECT_LT(run.summary().conservation_defect, 1e-13) << epsilon;
    EXPECT_EQ(run.setup().open_faces(),
              (std::vector<std::string>{"left", "right", "bottom", "top", "solid-1", "corner"}));
    // No mass passes any wall, and no energy passes the specular one.
    const auto& received = run.last().received;
    const std::size_t count = run.setup().equation->invariants().size();
    for (std::size_t face = 0; face < 6; ++face) EXPECT_NEAR(received[face * count], 0.0, 1e-15) << epsilon;
    EXPECT_NEAR(received[5 * count + count - 1], 0.0, 1e-15) << epsilon;
  }
}

TEST(solids, fields_are_undefined_inside_and_only_there) {
  simulation run(apsis::parse_case(gas_in_a_box, "box.toml", with_boxes()));
  const auto rho = run.fields().values.front();
  int solid = 0;
  for (const double value : rho) solid += std::isnan(value) ? 1 : 0;
  EXPECT_EQ(solid, 4 * 5 + 4 * 8);
}

}  // namespace space_dimensions_test
