// Built-in cases name reliable figures. On smaller meshes these figures agree with independent formulas.
#include <apsis/config/case.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace decks_test {

namespace {

using apsis::simulation;
constexpr double pi = std::numbers::pi;

simulation run_of(const std::string& name, const std::vector<std::string>& overrides) {
  return simulation(apsis::load_case(name, overrides));
}

void finish(simulation& run) {
  while (!run.finished()) run.advance();
}

/// Returns the mean of the density in the cells between two points.
double mean_density(const simulation& run, double from, double to) {
  const auto fields = run.fields();
  double sum = 0.0, cells = 0.0;
  for (std::size_t i = 0; i < fields.x.size(); ++i)
    if (fields.x[i] > from && fields.x[i] < to) {
      sum += fields.values.front()[i];
      cells += 1.0;
    }
  return sum / cells;
}

/// Returns the complex amplitude of the stress on the oscillating plate over U, in the last period of two.
std::complex<double> stress_on_plate(const std::string& kn) {
  simulation run = run_of("gas/oscillating-wall", {"parameters.kn=" + kn, "space.cells=30",
                                                   "velocity.points=[16, 10]", "velocity.max=6"});
  const double U = run.config().constants.at("U");
  std::complex<double> sum = 0.0;
  while (!run.finished()) {
    run.advance();
    const auto& last = run.last();
    if (last.t - last.dt < 2.0 * pi * 0.9999999) continue;
    const double stress = last.flux[2];  // mass, momentum_x, momentum_y through the left face
    sum += stress * std::exp(std::complex<double>(0.0, -(last.t - 0.5 * last.dt))) * last.dt;
  }
  return sum / (pi * U);
}

}  // namespace

TEST(decks, oscillating_wall_has_the_stress_of_stokes_with_slip) {
  const std::complex<double> i(0.0, 1.0);
  const double epsilon = 0.01, slip = 1.0162 * std::numbers::sqrt2 * epsilon;
  const auto exact = std::sqrt(i * epsilon) / (1.0 + slip * std::sqrt(i / epsilon));
  const auto found = stress_on_plate("0.01");
  // The slip is that of a steady shear, which has an error of order epsilon ω. Four cells resolve the layer.
  EXPECT_NEAR(std::abs(found), std::abs(exact), 0.02 * std::abs(exact));
  EXPECT_NEAR(std::arg(found), std::arg(exact), 0.03);
}

TEST(decks, oscillating_wall_has_the_stress_of_free_molecules) {
  const auto found = stress_on_plate("100");
  // With sixteen velocities 1/√(2π) has an error of a percent. A molecule has a hundredth of a collision.
  EXPECT_NEAR(std::abs(found), 1.0 / std::sqrt(2.0 * pi), 0.01);
  EXPECT_NEAR(std::arg(found), 0.0, 0.02);
}

TEST(decks, evaporation_has_the_pressure_drop_of_the_knudsen_layers) {
  simulation run = run_of("gas/evaporation", {"parameters.kn=0.02", "space.cells=30", "time.steady=1e-6"});
  finish(run);
  const double h = run.config().constants.at("h"), mass = run.last().flux[0];
  // In each layer p falls by 2.13204 u/√(2RT) (Sone, 2007). The layers occupy a few percent of the gap.
  EXPECT_NEAR(mass / h, std::numbers::sqrt2 / 2.13204, 0.01);
  EXPECT_NEAR(run.last().flux[3], -mass, 1e-3 * mass);
}

TEST(decks, beams_have_the_density_of_two_shocks_or_of_both_beams) {
  simulation dense = run_of("gas/beams", {"space.cells=100", "time.end=0.4"});
  finish(dense);
  // A piston of speed 2 in a gas of γ = 5/3 makes a shock with M = s + √(s² + 1) and s = (γ + 1)/4 · 2/a.
  const double s = 2.0 / 3.0 * 2.0 / std::sqrt(5.0 / 3.0), mach = s + std::sqrt(s * s + 1.0),
               ratio = 4.0 * mach * mach / (mach * mach + 3.0);
  EXPECT_NEAR(mean_density(dense, 0.1, 0.25), ratio, 0.01 * ratio);
  simulation free = run_of("gas/beams", {"space.cells=40", "time.end=0.2", "parameters.kn=1e12"});
  finish(free);
  const double both = 1.0 + std::erf(2.0 / std::numbers::sqrt2);
  EXPECT_NEAR(mean_density(free, -0.05, 0.05), both, 5e-3 * both);
}

TEST(decks, shock_has_the_slope_of_beckers_solution_as_the_mach_number_tends_to_1) {
  // The Navier–Stokes equations with Pr = 3/4 and constant viscosity μ = ε = 1 conserve h + u²/2 along a
  // shock. Then (4/3) μ u u' = m (γ + 1)/(2γ) (u − u₁)(u − u₂) (Becker, Z. Phys. 8, 1922). The shock is
  // steepest at √(u₁u₂).
  const double M = 1.2, gamma = 5.0 / 3.0, before = M * std::sqrt(gamma),
               behind = before * (M * M + 3.0) / (4.0 * M * M), middle = std::sqrt(before * behind),
               exact = before * (gamma + 1.0) / (2.0 * gamma) * (before - middle) * (middle - behind) /
                       (4.0 / 3.0 * middle);
  simulation run =
      run_of("gas/shock", {"parameters.M=1.2", "model.name=es-bgk", "model.prandtl=0.75",
                           "model.viscosity_exponent=0", "space.domain=[-60, 60]", "space.cells=100",
                           "velocity.max=8", "velocity.points=28", "time.end=2000", "time.steady=2e-6"});
  finish(run);
  const auto fields = run.fields();
  double steepest = 0.0;
  for (std::size_t i = 0; i + 1 < fields.x.size(); ++i)
    steepest =
        std::max(steepest, (fields.values[1][i] - fields.values[1][i + 1]) / (fields.x[i + 1] - fields.x[i]));
  // Burnett terms have the size (M − 1)².
  EXPECT_NEAR(steepest, exact, 0.02 * exact);
}

}  // namespace decks_test
