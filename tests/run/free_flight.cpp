// Free flight in the plane and in space, f(t, x, v) = f(0, x − v t, v). No wave and no velocity is parallel
// to an axis.
#include "laws.hpp"

#include <apsis/run/setup.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace free_flight_test {

namespace {

constexpr std::array<double, 3> lengths = {1.0, 0.8, 1.2};

/// A wave 1 + 0.3 sin 2π(n·x/L + shift), where n has the entries ±1.
struct wave {
  std::array<double, 3> n;
  double shift;

  double at(const std::array<double, 3>& x, int dimensions) const {
    double phase = shift;
    for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k) phase += n[k] * x[k] / lengths[k];
    return 1.0 + 0.3 * std::sin(2.0 * std::numbers::pi * phase);
  }
  std::string formula(int dimensions) const {
    std::string phase = fmt::format("{}", shift);
    for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k)
      phase += fmt::format(" + {:g}*{}/{:g}", n[k], "xyz"[k], lengths[k]);
    return fmt::format("1 + 0.3*sin(2*pi*({}))", phase);
  }
};

const std::array<wave, 4> waves = {
    {{{1, 1, 1}, 0.0}, {{1, -1, 1}, 0.1}, {{-1, 1, 1}, 0.3}, {{1, 1, -1}, 0.7}}};

/// Two pairs of opposite velocities, which may collide. The third component is used in space only.
const std::array<std::array<double, 3>, 4> velocities = {
    {{1.0, 0.6, -0.3}, {-1.0, -0.6, 0.3}, {-0.6, 1.0, 0.3}, {0.6, -1.0, -0.3}}};

/// Returns four velocities of the plane or of space. Each has its own wave.
std::string four_waves(int dimensions) {
  std::string list, initial, domain;
  for (std::size_t j = 0; j < 4; ++j) {
    const auto& v = velocities[j];
    list += dimensions == 2 ? fmt::format("[{}, {}], ", v[0], v[1])
                            : fmt::format("[{}, {}, {}], ", v[0], v[1], v[2]);
    initial += fmt::format("f_{} = \"{}\"\n", j + 1, waves[j].formula(dimensions));
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k)
    domain += fmt::format("[0, {}], ", lengths[k]);
  return fmt::format(
      "[model]\nname = \"discrete-velocity\"\nepsilon = 1e12\nvelocities = [{}]\ncollisions = [[1, 2, 3, "
      "4]]\n"
      "[initial]\n{}[space]\ndomain = [{}]\n[time]\nmethod = \"md-imex-6-3\"\nend = 0.1\n",
      list, initial, domain);
}

/// Returns the largest error at t = 0.1 on n cells along every direction.
double error_of_waves(int dimensions, int n) {
  // With this step the third-order error in time is as small as one of fifth order.
  const double dt = 0.02 / std::pow(n / 12.0, 5.0 / 3.0);
  const auto run =
      finished_run(four_waves(dimensions), {dimensions == 2 ? fmt::format("space.cells=[{0},{0}]", n)
                                                            : fmt::format("space.cells=[{0},{0},{0}]", n),
                                            fmt::format("time.dt={}", 0.1 / std::ceil(0.1 / dt))});
  const auto f = run.state();
  double largest = 0.0;
  for (int cell = 0; cell < run.mesh().size(); ++cell)
    for (std::size_t j = 0; j < 4; ++j) {
      auto origin = run.mesh().centre(cell);
      for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k)
        origin[k] -= velocities[j][k] * run.t();
      largest = std::max(
          largest, std::abs(f[static_cast<std::size_t>(cell) * 4 + j] - waves[j].at(origin, dimensions)));
    }
  return largest;
}

/// A gas with two sets of components in space.
const char* const gas = R"toml(
[model]
name = "bgk"
degrees_of_freedom = 5
epsilon = 1e12
[initial]
rho = "1 + 0.2*sin(2*pi*(x + y/0.8 - z/1.2))"
u = [0.3, -0.2, 0.1]
T = 1
[space]
domain = [[0, 1], [0, 0.8], [0, 1.2]]
[velocity]
max = 6.5
points = 10
[time]
method = "md-imex-6-3"
dt = 0.002
end = 0.008
)toml";

}  // namespace

TEST(free_flight, of_waves_in_the_plane_has_fifth_order) {
  const double coarse = error_of_waves(2, 24), fine = error_of_waves(2, 48);
  RecordProperty("order", fmt::format("{:.3f}", std::log2(coarse / fine)));
  EXPECT_GT(std::log2(coarse / fine), 4.8) << coarse << " " << fine;
}

TEST(free_flight, of_waves_in_space_has_fifth_order) {
  const double coarse = error_of_waves(3, 12), fine = error_of_waves(3, 24);
  RecordProperty("order", fmt::format("{:.3f}", std::log2(coarse / fine)));
  EXPECT_GT(std::log2(coarse / fine), 4.8) << coarse << " " << fine;
}

TEST(free_flight, of_a_gas_in_space_carries_every_component_with_its_velocity) {
  const auto rho = [](double x, double y, double z) {
    return 1.0 + 0.2 * std::sin(2.0 * std::numbers::pi * (x + y / 0.8 - z / 1.2));
  };
  apsis::simulation run(apsis::parse_case(gas, "gas", {"space.cells=[9,8,10]"}));
  const auto initial = run.state();
  finish(run);
  const auto f = run.state();
  const std::size_t row = f.size() / static_cast<std::size_t>(run.mesh().size()), points = row / 2;
  double largest = 0.0, density = 0.0;
  const auto first = run.mesh().centre(0);
  for (std::size_t k = 0; k < row; ++k) {
    // The data f(0, x, v) are ρ(x) times a function of v alone.
    const double shape = initial[k] / rho(first[0], first[1], first[2]);
    std::array<double, 3> v{};
    for (int d = 0; d < 3; ++d)
      v[static_cast<std::size_t>(d)] = run.setup().equation->velocities().speeds(d)[k % points];
    for (int cell = 0; cell < run.mesh().size(); ++cell) {
      const auto x = run.mesh().centre(cell);
      const double exact = shape * rho(x[0] - v[0] * run.t(), x[1] - v[1] * run.t(), x[2] - v[2] * run.t());
      largest = std::max(largest, std::abs(f[static_cast<std::size_t>(cell) * row + k] - exact));
      density = std::max(density, exact);
    }
  }
  // A wave has 12 cells, and a molecule with |v| = 4 crosses one wave. The tolerance covers the error of the
  // order above. A component with a wrong velocity would have an error of 0.1 times the density or more.
  RecordProperty("error", fmt::format("{:.2g}", largest / density));
  EXPECT_LT(largest / density, 2e-4);
}

}  // namespace free_flight_test
