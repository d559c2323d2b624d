// Fluxes from the gas to faces and solid boxes, cell face by cell face.
#include "cases_in_space.hpp"
#include "support/folder.hpp"

#include <apsis/config/case_json.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/core/text_file.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace surfaces_test {

using namespace apsis;
using namespace in_several_dimensions;
using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

namespace {

/// Returns a gas of three degrees of freedom between walls, on few velocities. `walls` has the tables
/// for the walls.
std::string gas_between(const std::string& space, const std::string& walls) {
  return R"toml(
[model]
name = "bgk"
epsilon = 0.5
degrees_of_freedom = 3
[initial]
rho = 1
T = 1
[velocity]
max = 6.5
points = 8
[time]
method = "md-imex-3-2"
safety = 1
end = 1000
[output]
surfaces = "all"
[space]
formulation = "finite-difference"
reconstruction = "upwind1"
boundary = "diffuse"
)toml" + space +
         walls;
}

/// A gas in the plane with a moving wall, a hot one and a cold box.
const std::string cavity = gas_between("cells = [6, 5]\ndomain = [[0.0, 1.2], [-1.0, 1.0]]\n", R"toml(
[boundary.top]
velocity = [0.3, 0]
[boundary.left]
T = 1.3
[[space.solid]]
name = "box"
from = [0.4, -0.2]
to = [0.8, 0.2]
T = 0.9
)toml");

simulation run_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return simulation(parse_case(text, "case.toml", overrides));
}

void finish(simulation& run) {
  while (!run.finished()) run.advance();
}

surface_table surface_of(const simulation& run, const std::string& name) {
  for (auto& one : run.surfaces())
    if (one.name == name) return one;
  ADD_FAILURE() << "no surface " << name;
  return {};
}

std::vector<double> column(const surface_table& surface, const std::string& name) {
  const auto& names = surface.numbers.columns;
  const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  std::vector<double> values;
  for (const auto& row : surface.numbers.rows) values.push_back(row.at(at));
  return values;
}

double largest(const std::vector<double>& values) {
  double size = 0.0;
  for (const double x : values) size = std::max(size, std::abs(x));
  return size;
}

/// Returns Σ area · value.
double total(const surface_table& surface, const std::string& name) {
  const auto area = column(surface, "area"), values = column(surface, name);
  double sum = 0.0;
  for (std::size_t k = 0; k < area.size(); ++k) sum += area[k] * values[k];
  return sum;
}

/// Checks that the tables, summed over the steps, give the amounts that the history receives.
void expect_balance(const std::string& text, const std::vector<std::string>& overrides = {}) {
  simulation run = run_of(text, overrides);
  const auto faces = run.setup().open_faces(), invariants = run.setup().equation->invariants();
  for (int step = 0; step < 3; ++step) {
    const std::vector<double> before = run.last().received;
    run.advance();
    const auto tables = run.surfaces();
    ASSERT_EQ(tables.size(), faces.size());
    for (std::size_t face = 0; face < tables.size(); ++face)
      for (std::size_t k = 0; k < invariants.size(); ++k) {
        ASSERT_EQ(tables[face].name, faces[face]);
        const double dt = run.last().dt, given = total(tables[face], invariants[k]) * dt;
        const std::size_t at = face * invariants.size() + k;
        double size = std::abs(run.last().received[at]);
        for (const double one : column(tables[face], invariants[k])) size += std::abs(one) * dt;
        // The tolerance covers the roundings of the sum over the cell faces, of quotients and products, and
        // of the sum over the steps.
        EXPECT_NEAR(given, before[at] - run.last().received[at], 1e-15 * size)
            << faces[face] << invariants[k];
        EXPECT_NEAR(given, -run.last().flux[at] * dt, 1e-15 * size) << faces[face] << invariants[k];
      }
  }
}

}  // namespace

TEST(surfaces, give_what_the_history_receives_on_a_line_in_the_plane_and_in_space) {
  expect_balance(cavity);
  expect_balance(cavity, {"space.reconstruction=weno5-z", "space.limiter=positivity"});
  expect_balance(cavity, {"model.velocity_dimensions=3", "model.degrees_of_freedom=5",
                          "boundary.top.velocity=[0.3, 0, 0.1]"});
  expect_balance(gas_between("cells = 9\n",
                             "[boundary.left]\nT = 1.2\n[[space.solid]]\nfrom = \"4/9\"\n"
                             "to = \"5/9\"\n"));
  expect_balance(gas_between("cells = [4, 3, 4]\n",
                             "[boundary.back]\nT = 1.2\nvelocity = [0.1, 0.2, 0]\n"
                             "[[space.solid]]\nfrom = [0.25, 0, 0.25]\n"
                             "to = [0.75, \"1/3\", 0.5]\n"));
  // Further cases have open ends and a periodic direction, a conservation law, and collisions
  // of cell averages.
  expect_balance(in_plane + "[output]\nsurfaces = [\"all\"]\n");
  expect_balance(
      "[model]\nname = \"broadwell\"\nepsilon = 0.1\n[space]\ncells = 10\nboundary = \"outflow\"\n"
      "[time]\nmethod = \"md-imex-3-2\"\nend = 1\ndt = 0.01\n[output]\nsurfaces = \"all\"\n");
}

TEST(surfaces, of_a_gas_at_rest_feel_its_pressure_and_nothing_else) {
  simulation run = run_of(cavity, {"boundary.top.velocity=[0, 0]", "boundary.left.T=1", "space.solid.1.T=1"});
  run.advance();
  for (const surface_table& one : run.surfaces()) {
    for (const double p : column(one, "pressure")) EXPECT_NEAR(p, 1.0, 1e-13) << one.name;
    // The columns are sums over 64 velocities of terms of the size of the pressure.
    for (const char* nothing : {"mass", "energy", "shear_stress", "heat_flux"})
      EXPECT_LT(largest(column(one, nothing)), 1e-14) << one.name << nothing;
    for (const char* one_of_rest : {"rho", "T"})
      for (const double value : column(one, one_of_rest)) EXPECT_NEAR(value, 1.0, 1e-13) << one.name;
    for (const char* nothing : {"u_x", "u_y"}) EXPECT_LT(largest(column(one, nothing)), 1e-14) << one.name;
  }
}

TEST(surfaces, have_a_row_for_every_cell_face_with_its_place) {
  simulation run = run_of(cavity);
  run.advance();
  const surface_table box = surface_of(run, "box"), top = surface_of(run, "top");
  EXPECT_THAT(box.numbers.columns,
              ElementsAre("s", "x", "y", "n_x", "n_y", "area", "mass", "momentum_x", "momentum_y", "energy",
                          "pressure", "shear_stress", "heat_flux", "rho", "u_x", "u_y", "T", "mass_arriving",
                          "mass_leaving", "energy_arriving", "energy_leaving", "T_w"));
  // Cells have the size 0.2 x 0.4. The box is two cells wide and one high. Its faces are counter-clockwise
  // from (0.4, -0.2).
  EXPECT_THAT(box.faces, ElementsAre("bottom", "bottom", "right", "top", "top", "left"));
  const auto near = [](std::vector<double> expected) {
    return testing::Pointwise(testing::DoubleNear(1e-15), std::move(expected));
  };
  EXPECT_THAT(column(box, "s"), near({0.1, 0.3, 0.6, 0.9, 1.1, 1.4}));
  EXPECT_THAT(column(box, "x"), near({0.5, 0.7, 0.8, 0.7, 0.5, 0.4}));
  EXPECT_THAT(column(box, "y"), near({-0.2, -0.2, 0.0, 0.2, 0.2, 0.0}));
  EXPECT_THAT(column(box, "area"), near({0.2, 0.2, 0.4, 0.2, 0.2, 0.4}));
  EXPECT_THAT(top.faces, testing::Each("top"));
  EXPECT_THAT(column(top, "s"), near({0.1, 0.3, 0.5, 0.7, 0.9, 1.1}));
  EXPECT_THAT(column(top, "y"), testing::Each(1.0));
  // The pressure is near 1, and its force points into the box. The normal momentum has the sign of n.
  const auto x = column(box, "momentum_x"), y = column(box, "momentum_y");
  EXPECT_GT(x[5], 0.5);
  EXPECT_LT(x[2], -0.5);
  EXPECT_GT(y[0], 0.5);
  EXPECT_LT(y[3], -0.5);
  EXPECT_EQ(column(box, "pressure")[2], -x[2]);
  EXPECT_EQ(column(box, "pressure")[0], y[0]);
  EXPECT_EQ(column(box, "shear_stress")[2], y[2]);
  EXPECT_EQ(column(box, "shear_stress")[0], x[0]);
  // The lid pulls the gas to the right, and the gas pulls the lid to the left. The lid does work on the gas.
  const auto shear = column(top, "shear_stress"), energy = column(top, "energy"),
             heat = column(top, "heat_flux");
  for (std::size_t k = 0; k < shear.size(); ++k) {
    EXPECT_LT(shear[k], 0.0);
    EXPECT_NEAR(heat[k], energy[k] - 0.3 * shear[k], 1e-16);
  }
}

TEST(surfaces, in_a_steady_cavity_with_a_box_balance_to_rounding) {
  // Without sources the amounts from all walls add up to the change of the content per unit of time.
  const std::vector<std::string> steady = {"time.steady=5e-15"};
  simulation run = run_of(cavity, steady);
  finish(run);
  ASSERT_LT(run.t(), 1000.0);
  for (const std::string invariant : {"mass", "momentum_x", "momentum_y", "energy"}) {
    double sum = 0.0;
    for (const surface_table& one : run.surfaces()) {
      sum += total(one, invariant);
    }
    EXPECT_LT(std::abs(sum), 1e-12) << invariant;
  }
  double heat = 0.0;
  for (const surface_table& one : run.surfaces()) heat += total(one, "heat_flux");
  // The work of the lid becomes heat.
  EXPECT_NEAR(heat, -0.3 * total(surface_of(run, "top"), "shear_stress"), 1e-12);
  EXPECT_GT(heat, 1e-3);
}

TEST(surfaces, of_a_symmetric_flow_have_symmetric_profiles) {
  // The cavity is heated below and has a cold box in the middle. It is symmetric in x and 1 − x.
  simulation run = run_of(gas_between("cells = [8, 6]\n", R"toml(
[boundary.bottom]
T = "1.2 + 0.1*cos(2*pi*(x - 0.5))"
[[space.solid]]
name = "box"
from = [0.25, "1/3"]
to = [0.75, "2/3"]
T = 0.9
)toml"),
                          {"time.end=0.5"});
  finish(run);
  const surface_table left = surface_of(run, "left"), right = surface_of(run, "right");
  const surface_table box = surface_of(run, "box");
  const auto mirrored = [](const std::vector<double>& values, double sign) {
    std::vector<double> back(values.rbegin(), values.rend());
    for (double& x : back) x *= sign;
    return back;
  };
  // Rounding errors of some hundred steps differ.
  const auto near = [](std::vector<double> expected) {
    return testing::Pointwise(testing::DoubleNear(1e-13), std::move(expected));
  };
  for (const char* name : {"pressure", "shear_stress", "heat_flux"}) {
    const double along_x = std::string(name) == "shear_stress" ? -1.0 : 1.0;
    EXPECT_THAT(column(left, name), near(column(right, name))) << name;
    for (const char* face : {"bottom", "top"}) {
      const auto values = column(surface_of(run, face), name);
      EXPECT_THAT(values, near(mirrored(values, along_x))) << face << name;
    }
    // Faces of the box: bottom 0 … 3, right 4, 5, top 6 … 9, left 10, 11.
    const auto values = column(box, name);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NEAR(values[k], along_x * values[3 - k], 1e-13) << name;
      EXPECT_NEAR(values[6 + k], along_x * values[9 - k], 1e-13) << name;
      EXPECT_NEAR(values[4 + k], values[11 - k], 1e-13) << name;
    }
  }
  EXPECT_GT(largest(column(left, "shear_stress")), 1e-4);
  EXPECT_GT(column(box, "heat_flux")[1], 0.01);  // heat from the hot wall below
}

TEST(surfaces, of_couette_flow_in_the_plane_have_the_stress_of_the_line) {
  const std::vector<std::string> steps = {"time.dt=0.01", "time.end=0.4"};
  const auto text = [](const std::string& space, const std::string& walls) {
    std::string made = gas_between(space, walls);
    made.erase(made.find("safety = 1\n"), 11);
    return made;
  };
  simulation line = run_of(text("cells = 7\n", "[boundary.right]\nvelocity = [0, 0.3]\n"),
                           {steps[0], steps[1], "model.velocity_dimensions=2"});
  finish(line);
  const double stress = column(surface_of(line, "right"), "shear_stress").front(),
               heat = column(surface_of(line, "right"), "heat_flux").front();
  EXPECT_LT(stress, -0.05);
  const std::string periodic = "boundary = \"periodic\"\n";
  std::string in_plane_text = text("cells = [4, 7]\n", R"toml([boundary.bottom]
kind = "diffuse"
[boundary.top]
kind = "diffuse"
velocity = [0.3, 0]
)toml");
  in_plane_text.replace(in_plane_text.find("boundary = \"diffuse\"\n"), 21, periodic);
  simulation plane = run_of(in_plane_text, steps);
  finish(plane);
  const surface_table top = surface_of(plane, "top");
  ASSERT_EQ(top.faces.size(), 4U);
  // Sums over the velocities have another order, over 40 steps.
  for (const double one : column(top, "shear_stress")) EXPECT_NEAR(one, stress, 1e-14);
  for (const double one : column(top, "heat_flux")) EXPECT_NEAR(one, heat, 1e-14);
  for (const double one : column(surface_of(plane, "bottom"), "pressure"))
    EXPECT_NEAR(one, column(surface_of(line, "left"), "pressure").front(), 1e-14);
}

TEST(surfaces, without_collisions_have_the_stress_and_heat_flux_of_free_molecules) {
  // Each half of the velocities has the Maxwellian of the wall that it left. The densities are such that
  // equal numbers J cross: ρ₁ √T₁ = ρ₂ √T₂ and ρ₁ + ρ₂ = 2, so
  //   J = √(2/π) √(T₁ T₂)/(√T₁ + √T₂).
  // A molecule that crosses has the mean energy 2 T + U²/2 and momentum U.
  std::string text = gas_between("cells = [3, 4]\n", R"toml([boundary.bottom]
kind = "diffuse"
[boundary.top]
kind = "diffuse"
T = 1.2
velocity = [0.3, 0]
)toml");
  text.replace(text.find("boundary = \"diffuse\"\n"), 21, "boundary = \"periodic\"\n");
  text.replace(text.find("max = 6.5\npoints = 8\n"), 21,
               "set = [\"gauss-hermite\", \"half-range-gauss-hermite\"]\npoints = [12, 12]\n");
  simulation run = run_of(text, {"model.epsilon=1e12", "time.end=1500", "time.steady=1e-8"});
  finish(run);
  const double T1 = 1.2, T2 = 1.0, U = 0.3,
               J = std::sqrt(2.0 / std::numbers::pi) * std::sqrt(T1 * T2) / (std::sqrt(T1) + std::sqrt(T2));
  const double heat_below = J * (2.0 * (T1 - T2) + 0.5 * U * U),
               heat_above = J * (2.0 * (T2 - T1) + 0.5 * U * U);
  const surface_table top = surface_of(run, "top"), bottom = surface_of(run, "bottom");
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(column(bottom, "shear_stress")[k], J * U, 1e-4 * J * U);
    EXPECT_NEAR(column(top, "shear_stress")[k], -J * U, 1e-4 * J * U);
    EXPECT_NEAR(column(bottom, "heat_flux")[k], heat_below, 1e-4 * heat_below);
    EXPECT_NEAR(column(top, "heat_flux")[k], heat_above, 1e-4 * std::abs(heat_above));
    EXPECT_NEAR(column(top, "energy")[k], -heat_below, 1e-4 * heat_below);
    // The gas is uniform: ρ₁ : ρ₂ = √T₂ : √T₁ and u = U ρ₁/2. With the energy of both halves its temperature
    // is √(T₁T₂) + U² ρ₁ρ₂/12 for three degrees of freedom. It is slower and colder than the upper wall.
    const double rho1 = 2.0 * std::sqrt(T2) / (std::sqrt(T1) + std::sqrt(T2)), rho2 = 2.0 - rho1;
    for (const surface_table* wall : {&top, &bottom}) {
      EXPECT_NEAR(column(*wall, "rho")[k], 1.0, 1e-4);
      EXPECT_NEAR(column(*wall, "u_x")[k], 0.5 * U * rho1, 1e-4 * U);
      EXPECT_NEAR(column(*wall, "u_y")[k], 0.0, 1e-12);
      EXPECT_NEAR(column(*wall, "T")[k], std::sqrt(T1 * T2) + U * U * rho1 * rho2 / 12.0, 1e-4);
    }
  }
}

TEST(surfaces, have_the_state_of_the_gas_from_the_distribution_at_the_face) {
  // Beside a vacuum only the half that leaves exists. For a Maxwellian at rest it has half of the density,
  // the velocity √(2/π) and the temperature (3 − 2/π)/3. The run has taken no step.
  for (const char* face : {"left", "right"})
    for (const char* points : {"24", "25"}) {
      std::string text = gas_between("cells = 6\n", fmt::format("[boundary.{}]\nkind = \"vacuum\"\n", face));
      text.replace(text.find("max = 6.5\npoints = 8\n"), 21, fmt::format("max = 7\npoints = {}\n", points));
      const bool odd = std::string(points) == "25";  // has a velocity along the face, which counts fully
      if (!odd) text.replace(text.find("max = 7\n"), 8, "set = \"half-range-gauss-hermite\"\n");
      const simulation run = run_of(text);
      const surface_table end = surface_of(run, face);
      const double sign = std::string(face) == "right" ? 1.0 : -1.0, pi = std::numbers::pi;
      // The midpoint rule for a half Maxwellian has an error of Δv²/12 times its slope.
      const double near = odd ? 0.05 : 1e-6;
      EXPECT_NEAR(column(end, "rho")[0], odd ? 0.5 + 0.5 * 14.0 / 25.0 / std::sqrt(2.0 * pi) : 0.5, 1e-6);
      EXPECT_NEAR(column(end, "u")[0], sign * std::sqrt(2.0 / pi) * 0.5 / column(end, "rho")[0], near);
      if (!odd) {
        EXPECT_NEAR(column(end, "T")[0], 1.0 - 2.0 / (3.0 * pi), near);
      }
      EXPECT_TRUE(std::isnan(column(end, "pressure")[0]));
    }
}

TEST(surfaces, of_kramers_problem_have_the_velocity_of_the_gas_at_the_wall) {
  // The unit is k = ε √2 times the gradient of u beyond the Knudsen layer. In this unit the velocity of the
  // gas at a wall is σ_P − Y(0). The slip coefficient is σ_P = 1.0158, and Y(0) = .30908 (Loyalka, Petrellis,
  // Storvick, Phys. Fluids 18, 1975). The plates are 10 k apart, and the layers have decayed in the middle.
  std::string text = gas_between("cells = 40\n", "[boundary.right]\nvelocity = [0, 0.1]\n");
  text.replace(text.find("max = 6.5\npoints = 8\n"), 21,
               "set = \"half-range-gauss-hermite\"\npoints = [16, 4]\n");
  simulation run =
      run_of(text, {"model.velocity_dimensions=2", "model.epsilon=\"0.1/sqrt(2)\"", "time.steady=1e-5",
                    "space.reconstruction=upwind5", "time.method=md-imex-6-3", "space.domain=[0, 1]"});
  finish(run);
  const auto fields = run.fields();
  const auto at = std::find(fields.names.begin(), fields.names.end(), "u_y") - fields.names.begin();
  const auto& u = fields.values.at(static_cast<std::size_t>(at));
  const double gradient = (u[21] - u[18]) / (3.0 / 40.0);
  const double slip = column(surface_of(run, "left"), "u_y")[0] / (0.1 * gradient);
  EXPECT_NEAR(slip, 1.0158 - 0.30908, 0.02);
  EXPECT_NEAR(column(surface_of(run, "right"), "u_y")[0], 0.1 - slip * 0.1 * gradient, 1e-4);
}

}  // namespace surfaces_test
