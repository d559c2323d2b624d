// Divergence and vorticity of a gas by central differences of the bulk velocity.
#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flow_fields_test {

namespace {

using apsis::simulation;

constexpr double pi = std::numbers::pi;

const std::string gas = R"toml(
[model]
name = "bgk"
epsilon = 0.1
velocity_dimensions = 2
degrees_of_freedom = 3
[initial]
rho = "1 + 0.1*cos(x)"
u = ["0.2*sin(x)*cos(y)", "-0.2*cos(x)*sin(y)"]
T = 1
[space]
cells = [24, 16]
domain = [[0, 6.283185307179586], [0, 6.283185307179586]]
formulation = "finite-difference"
[velocity]
max = 8
points = 20
[time]
method = "md-imex-6-3"
end = 0
safety = 1
[output]
fields = ["divergence", "vorticity"]
)toml";

simulation run_of(const std::vector<std::string>& overrides = {}) {
  return simulation(apsis::parse_case(gas, "gas.toml", overrides));
}

std::vector<double> field_of(const simulation& run, const std::string& name) {
  const auto table = run.fields();
  const auto found = std::find(table.names.begin(), table.names.end(), name);
  if (found == table.names.end()) throw std::out_of_range("no field " + name);
  return table.values[static_cast<std::size_t>(found - table.names.begin())];
}

/// Central differences multiply the derivative of a sine by sin(h)/h. Velocities sampled at 20 points have
/// errors below 1e-9 of the thermal speed.
constexpr double of_sampling = 1e-9;

}  // namespace

TEST(flow_fields, of_a_vortex_in_the_plane_are_those_of_central_differences) {
  const simulation run = run_of();
  const auto vorticity = field_of(run, "vorticity"), divergence = field_of(run, "divergence");
  const double hx = 2.0 * pi / 24.0, hy = 2.0 * pi / 16.0;
  const double sx = std::sin(hx) / hx, sy = std::sin(hy) / hy;
  for (int i = 0; i < 24; ++i)
    for (int j = 0; j < 16; ++j) {
      const double x = (i + 0.5) * hx, y = (j + 0.5) * hy;
      const auto cell = static_cast<std::size_t>(16 * i + j);
      // The expected values are those of ∂u_y/∂x − ∂u_x/∂y and of ∂u_x/∂x + ∂u_y/∂y.
      EXPECT_NEAR(vorticity[cell], 0.2 * (sx + sy) * std::sin(x) * std::sin(y), of_sampling);
      EXPECT_NEAR(divergence[cell], 0.2 * (sx - sy) * std::cos(x) * std::cos(y), of_sampling);
    }
}

TEST(flow_fields, have_the_unit_of_a_rate) {
  const auto table = run_of().fields();
  for (const std::string name : {"divergence", "vorticity"}) {
    const auto found = std::find(table.names.begin(), table.names.end(), name);
    ASSERT_NE(found, table.names.end());
    EXPECT_EQ(apsis::unit_of(table.dimensions[static_cast<std::size_t>(found - table.names.begin())]), "1/s");
  }
}

TEST(flow_fields, of_a_flow_with_the_vorticity_u_have_three_components) {
  // In the flow of Arnold, Beltrami and Childress ∇×u = u and ∇·u = 0.
  constexpr int n = 8;
  const simulation run = run_of(
      {"model.velocity_dimensions=3", "space.cells=[8, 8, 8]",
       "space.domain=[[0, 6.283185307179586], [0, 6.283185307179586], [0, 6.283185307179586]]",
       "initial.u=[\"0.1*sin(z) + 0.03*cos(y)\", \"0.2*sin(x) + 0.1*cos(z)\", \"0.03*sin(y) + 0.2*cos(x)\"]",
       "velocity.max=6", "velocity.points=12",
       "output.fields=[\"vorticity_x\", \"vorticity_y\", \"vorticity_z\", \"divergence\"]"});
  const double h = 2.0 * pi / n, s = std::sin(h) / h;
  for (const char axis : {'x', 'y', 'z'}) {
    const auto u = field_of(run, std::string("u_") + axis),
               w = field_of(run, std::string("vorticity_") + axis);
    for (std::size_t cell = 0; cell < u.size(); ++cell) EXPECT_NEAR(w[cell], s * u[cell], 1e-5);
  }
  for (const double div : field_of(run, "divergence")) EXPECT_NEAR(div, 0.0, 1e-5);
}

TEST(flow_fields, of_a_shear_on_a_line_have_the_derivative_along_it) {
  const simulation run =
      run_of({"space.cells=40", "space.domain=[0, 6.283185307179586]", "initial.u=[0, \"0.2*sin(x)\"]"});
  const auto vorticity = field_of(run, "vorticity");
  const double h = 2.0 * pi / 40.0;
  for (std::size_t cell = 0; cell < vorticity.size(); ++cell)
    EXPECT_NEAR(vorticity[cell], 0.2 * std::sin(h) / h * std::cos((static_cast<double>(cell) + 0.5) * h),
                of_sampling);
  for (const double div : field_of(run, "divergence")) EXPECT_NEAR(div, 0.0, of_sampling);
}

TEST(flow_fields, of_a_gas_with_one_velocity_are_the_divergence_alone) {
  const std::vector<std::string> line = {"model.velocity_dimensions=1", "space.cells=40",
                                         "space.domain=[0, 6.283185307179586]", "initial.u=0.2*sin(x)",
                                         "output.fields=[\"divergence\"]"};
  const simulation run = run_of(line);
  const auto divergence = field_of(run, "divergence");
  const double h = 2.0 * pi / 40.0;
  for (std::size_t cell = 0; cell < divergence.size(); ++cell)
    EXPECT_NEAR(divergence[cell], 0.2 * std::sin(h) / h * std::cos((static_cast<double>(cell) + 0.5) * h),
                of_sampling);
}

TEST(flow_fields, in_solid_boxes_are_undefined_and_one_sided_beside_them) {
  const std::string box = R"toml(
[[space.solid]]
name = "box"
from = [4, 4]
to = [6, 7]
)toml";
  // One-sided and central differences are exact for linear functions, but not across the periodic faces.
  const simulation run(apsis::parse_case(gas + box, "gas.toml",
                                         {"space.domain=[[0, 24], [0, 16]]", "initial.rho=1",
                                          "initial.u=[\"0.01*x - 0.02*y\", \"0.03*x + 0.02*y\"]"}));
  const auto vorticity = field_of(run, "vorticity"), divergence = field_of(run, "divergence");
  for (int i = 1; i < 23; ++i)
    for (int j = 1; j < 15; ++j) {
      const auto cell = static_cast<std::size_t>(16 * i + j);
      const bool solid = i >= 4 && i < 6 && j >= 4 && j < 7;
      ASSERT_EQ(std::isnan(vorticity[cell]), solid) << i << ' ' << j;
      if (solid) continue;
      EXPECT_NEAR(vorticity[cell], 0.05, of_sampling) << i << ' ' << j;
      EXPECT_NEAR(divergence[cell], 0.03, of_sampling) << i << ' ' << j;
    }
}

}  // namespace flow_fields_test
