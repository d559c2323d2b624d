// Runs of axisymmetric cases: uniform gas, budgets of rings, fields, restarts, and refused cases.
#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/run/body_loads.hpp>
#include <apsis/run/compute_surfaces.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace axisymmetric_test {
namespace {

/// Returns a case of a tube about the axis: gas between two planes and a cylinder.
std::string tube(const std::string& sides, const std::string& initial = "rho = 1\nT = 1") {
  return R"(
[model]
name = "bgk"
epsilon = 0.2
[initial]
)" + initial +
         R"(
[space]
geometry = "axisymmetric"
cells = [10, 8]
domain = [[0, 1.5], [0, 1]]
)" + sides +
         R"(
[velocity]
max = 5
points = 8
rings = 6
angles = 12
[time]
method = "md-imex-5-2"
end = 9
safety = 1
)";
}

const std::string ball = R"([[space.body]]
name = "ball"
shape = "circle"
centre = [0.7, 0]
radius = 0.45
T = 1
)";

apsis::case_config make_case(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return apsis::parse_case(text, "tube.toml", overrides);
}

void advance(apsis::simulation& run, int steps) {
  for (int step = 0; step < steps && !run.finished(); ++step) run.advance();
}

/// Returns the largest |a − b| over the largest |a|.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0, size = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    largest = std::max(largest, std::abs(a[k] - b[k]));
    size = std::max(size, std::abs(a[k]));
  }
  return largest / size;
}

const std::vector<double>& column(const apsis::field_table& table, const std::string& name) {
  const auto found = std::find(table.names.begin(), table.names.end(), name);
  return table.values.at(static_cast<std::size_t>(found - table.names.begin()));
}

}  // namespace

TEST(axisymmetric_run, gas_at_rest_stays_as_it_is_past_a_sphere) {
  for (const std::string model : {"bgk", "shakhov", "es-bgk"})
    for (const std::string scheme : {"upwind5", "weno5-z"})
      for (const std::string limiter : {"none", "positivity"}) {
        apsis::simulation run(make_case(
            tube("boundary = \"diffuse\"\n[boundary.left]\nT = 1\n[boundary.right]\nkind = \"inflow\"\nrho = "
                 "1\nT = 1\n[boundary.top]\nT = 1\n" +
                 ball),
            {"model.name=\"" + model + "\"", "space.reconstruction=\"" + scheme + "\"",
             "space.limiter=\"" + limiter + "\""}));
        const std::vector<double> before = run.state();
        advance(run, 3);
        // Differences of F = r f are of size 1, and the first cell has r = 1/16. The Gaussian of es-bgk
        // contains the stress from sums over six rings, but the Maxwellian does not.
        EXPECT_LT(difference(before, run.state()), model == "es-bgk" ? 1e-4 : 3e-14)
            << model << scheme << limiter;
      }
}

TEST(axisymmetric_run, mass_and_energy_are_those_of_the_ring_and_are_conserved) {
  const std::string initial =
      "rho = \"1 + 0.5*x*y\"\nu = [\"0.3*y\", \"-0.2*y\", \"0.4*y\"]\nT = \"1 + 0.2*x\"";
  for (const std::string limiter : {"none", "positivity"}) {
    apsis::simulation run(make_case(
        tube("boundary = \"symmetry\"\n[boundary.top]\nkind = \"diffuse\"\nT = 1\naccommodation = 0\n",
             initial),
        {"space.limiter=\"" + limiter + "\""}));
    // The mass is 2π ∫∫ (1 + xr/2) r dr dx = 2π (3/4 + 3/16). The sum over cells is a midpoint rule.
    EXPECT_NEAR(run.last().total.front(), 2.0 * std::numbers::pi * (0.75 + 0.1875), 1e-2);
    const std::vector<double> before = run.last().total;
    advance(run, 10);
    EXPECT_NEAR(run.last().total.front(), before.front(), 1e-13 * before.front());
    EXPECT_NEAR(run.last().total.back(), before.back(), 1e-13 * before.back());
    EXPECT_LT(run.summary().conservation_defect, 1e-13);
    if (limiter == "positivity") {
      EXPECT_EQ(run.summary().negative_values, 0);
      EXPECT_TRUE(run.promises().positivity);
    }
  }
}

TEST(axisymmetric_run, the_balance_past_a_body_includes_all_that_its_wall_gives) {
  apsis::simulation run(
      make_case(tube("boundary = \"outflow\"\n[boundary.left]\nkind = \"inflow\"\nrho = 1\nu = [1, "
                     "0, 0]\nT = 1\n" +
                         ball + "velocity = [0, 0, \"0.4*y\"]\n",
                     "rho = 1\nu = [1, 0, 0]\nT = 1"),
                {"output.surfaces=[\"ball\"]"}));
  advance(run, 5);
  EXPECT_LT(run.summary().conservation_defect, 1e-13);
  const auto table = run.surfaces().front();
  const auto place = [&](const std::string& name) {
    const auto& names = table.numbers.columns;
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  double drag = 0.0, area = 0.0, turning = 0.0;
  for (const auto& row : table.numbers.rows) {
    area += row[place("area")];
    drag += row[place("area")] * row[place("momentum_x")];
    turning += row[place("area")] * row[place("y")] * row[place("momentum_z")];
  }
  // The table ends after the half circle.
  EXPECT_NEAR(table.numbers.rows.back().front(), std::numbers::pi * 0.45, 0.1);
  // The area is that of the chords of a circle with five cells per radius.
  EXPECT_NEAR(area, 4.0 * std::numbers::pi * 0.45 * 0.45, 0.03 * area);
  const apsis::body_load load = apsis::body_loads(run.setup(), run.last()).front();
  EXPECT_GT(drag, 0.1);
  EXPECT_NEAR(load.force[0], drag, 1e-12 * drag);
  EXPECT_EQ(load.force[1], 0.0);
  // The gas slows the rotation of the ball, so the torque about the axis is negative.
  EXPECT_LT(turning, 0.0);
  EXPECT_NEAR(load.torque.front(), turning, 1e-12 * std::abs(turning));
}

TEST(axisymmetric_run, adiabatic_bodies_receive_no_heat_and_ends_at_equilibrium_keep_a_gas_at_rest) {
  const std::string adiabatic = ball.substr(0, ball.find("T = 1")) + "kind = \"adiabatic\"\n";
  apsis::simulation run(
      make_case(tube("boundary = \"outflow\"\n[boundary.left]\nkind = \"inflow\"\nrho = 1\nu = [1, 0, "
                     "0]\nT = 1\n" +
                         adiabatic,
                     "rho = 1\nu = [1, 0, 0]\nT = 1"),
                {"output.surfaces=[\"ball\"]"}));
  advance(run, 5);
  const apsis::body_load load = apsis::body_loads(run.setup(), run.last()).front();
  EXPECT_GT(load.force[0], 0.1);
  EXPECT_NEAR(load.heat, 0.0, 1e-13 * load.force[0]);  // sums of thousands of terms
  for (const std::string end : {"kind = \"far-field\"\nrho = 1\nT = 1", "kind = \"pressure\"\np = 1"}) {
    // The end is at both kinds of faces, x = const and r = const.
    apsis::simulation open(
        make_case(tube("boundary = \"diffuse\"\n[boundary.left]\nT = 1\n[boundary.right]\n" + end +
                       "\n[boundary.top]\n" + end)));
    const std::vector<double> before = open.state();
    advance(open, 3);
    EXPECT_LT(difference(before, open.state()), 3e-14) << end;
  }
}

TEST(axisymmetric_run, fields_and_f_are_those_of_the_gas_and_not_of_r_f) {
  const apsis::simulation run(
      make_case(tube("boundary = \"outflow\"\n", "rho = \"1 + y\"\nu = [0.1, \"0.3*y\", \"0.2*y\"]\nT = 0.9"),
                {"output.fields=[\"rho\", \"divergence\", \"vorticity_x\"]"}));
  const apsis::field_table fields = run.fields();
  const auto &rho = column(fields, "rho"), &u = column(fields, "u_y"), &T = column(fields, "T");
  for (std::size_t k = 0; k < rho.size(); ++k) {
    EXPECT_NEAR(rho[k], 1.0 + fields.y[k], 1e-13);
    EXPECT_NEAR(u[k], 0.3 * fields.y[k], 1e-13);
    EXPECT_NEAR(T[k], 0.9, 1e-13);
    // For rigid rotation and uniform expansion, ∂_r u_r + u_r/r and ∂_r u_θ + u_θ/r are constants.
    EXPECT_NEAR(column(fields, "divergence")[k], 0.6, 1e-12);
    EXPECT_NEAR(column(fields, "vorticity_x")[k], 0.4, 1e-12);
  }
}

TEST(axisymmetric_run, continues_from_its_state_with_equal_bits) {
  const auto config =
      make_case(tube("boundary = \"diffuse\"\n[boundary.left]\nT = 1\n[boundary.right]\nT = "
                     "1.4\n[boundary.top]\nT = 1\n" +
                     ball));
  apsis::simulation whole(config), first(config), second(config);
  advance(whole, 6);
  advance(first, 3);
  second.restore(first.save());
  advance(second, 3);
  EXPECT_EQ(whole.state(), second.state());
}

TEST(axisymmetric_run, a_line_of_r_has_the_entropy_of_f_which_decays) {
  apsis::simulation run(make_case(R"(
[model]
name = "bgk"
epsilon = 0.1
[initial]
rho = "x < 0.5 ? 1 : 0.2"
u = [0, 0.3, 0]
T = 1
[space]
geometry = "axisymmetric"
cells = [16]
domain = [0, 1]
reconstruction = "upwind1"
[boundary.right]
kind = "diffuse"
T = 1
accommodation = 0
[velocity]
max = 5
points = 8
rings = 8
angles = 16
[time]
method = "md-imex-5-2"
end = 0.3
safety = 1
)"));
  double before = run.last().entropy;
  // The entropy is Σ f log f r over 2π, ρ (log ρ − (3/2) log 2πe), for ρ = 1 or 0.2 and a Gaussian of
  // variance 1.
  const double gaussian = 1.5 * std::log(2.0 * std::numbers::pi * std::numbers::e);
  EXPECT_NEAR(before,
              2.0 * std::numbers::pi * (0.125 * (0.0 - gaussian) + 0.375 * 0.2 * (std::log(0.2) - gaussian)),
              1e-2);
  while (!run.finished()) {
    run.advance();
    EXPECT_LE(run.last().entropy, before);
    before = run.last().entropy;
  }
}

}  // namespace axisymmetric_test
