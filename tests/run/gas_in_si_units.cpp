// Runs of a gas in SI units agree with formulas in SI units. Also the local Knudsen number.
#include <apsis/config/case.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/run/records.hpp>
#include <apsis/run/result_units.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gas_in_si_units_test {

using namespace apsis;
using std::numbers::pi;

namespace {

constexpr double k_B = 1.380649e-23, m_argon = 66.3e-27;

double viscosity_of_argon(double T) {
  return 2.117e-5 * std::pow(T / 273.0, 0.81);
}

void finish(simulation& run) {
  while (!run.finished()) run.advance();
}

/// Returns a field at the end of a run in the units of its case.
std::vector<double> field_of(const simulation& run, const std::string& name) {
  run_records records(run);
  records.add_snapshot(run);
  const field_series fields = result_units(run.config()).convert(records.fields());
  const auto at = std::find(fields.names.begin(), fields.names.end(), name) - fields.names.begin();
  return fields.snapshots.back().values.at(static_cast<std::size_t>(at));
}

/// Returns the last value of a column of the history in the units of the case.
double last_of(const simulation& run, const std::string& column) {
  run_records records(run);
  records.add_step(run.last());
  const numeric_table history = result_units(run.config()).convert(records.history(), run);
  const auto at = std::find(history.columns.begin(), history.columns.end(), column) - history.columns.begin();
  return history.rows.back().at(static_cast<std::size_t>(at));
}

const std::string beams = R"toml(
[gas]
name = "argon"
pressure = "10 Pa"
temperature = "300 K"
length = "1 mm"
[model]
name = "bgk"
[initial]
[[initial.part]]
weight = 0.5
rho = 1
u = 0.6
T = 1
[[initial.part]]
weight = 0.5
rho = 1
u = -0.6
T = 1
[space]
cells = 6
[velocity]
max = 8.0
points = 40
[time]
method = "md-imex-8-3-mixed"
end = "1 us"
dt = "10 ns"
[output]
units = "SI"
fields = ["rho", "T", "p", "stress"]
)toml";

TEST(gas_in_si_units, stress_relaxes_in_the_time_of_viscosity_over_pressure) {
  // In a uniform gas σ' = −(p/μ)σ for all three models, with constant p, T and μ(T).
  for (const char* model : {"bgk", "shakhov", "es-bgk"}) {
    simulation run(parse_case(beams, "beams.toml", {std::string("model.name=") + model}));
    const double before = field_of(run, "stress").front();
    finish(run);
    const double T = field_of(run, "T").front(), p = field_of(run, "p").front();
    EXPECT_NEAR(T, 300.0 * (1.0 + 0.36 / 3.0), 1e-6) << model;
    EXPECT_NEAR(p, field_of(run, "rho").front() * k_B / m_argon * T, 1e-10) << model;
    // The stress of the beams is 2/3 ρu². The formulas of Maxwellians on the grid have errors of 1e-8.
    EXPECT_NEAR(before, 2.0 / 3.0 * 10.0 * 0.36, 1e-6) << model;
    // The error 1e-5 is that of a third-order method with steps of a 45th of the relaxation time.
    const double decay = std::exp(-1e-6 * p / viscosity_of_argon(T));
    EXPECT_NEAR(field_of(run, "stress").front() / before, decay, 1e-5 * decay) << model;
  }
}

/// Returns the case of the channel with an initial state near the steady one: T linear, p constant.
simulation channel(const std::string& pressure, const std::vector<std::string>& more) {
  std::vector<std::string> overrides = {"gas.pressure=" + pressure, "initial.T=(350 - 50*x)/300",
                                        "initial.rho=1/(350 - 50*x)*324.3"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return simulation(load_case("gas/micro-channel", overrides));
}

/// Returns the mean of ρ/m over the channel in 1/m^3.
double number_density(const simulation& run) {
  const auto rho = field_of(run, "rho");
  double sum = 0.0;
  for (const double one : rho) sum += one / m_argon;
  return sum / static_cast<double>(rho.size());
}

TEST(gas_in_si_units, heat_flux_of_a_channel_is_the_free_molecular_one_at_low_pressure) {
  // Molecules cross the channel without collisions (λ = 3.6 m). Those from a wall of temperature T_k form a
  // half Maxwellian of density n_k. The fluxes n_k √T_k are equal, and each molecule carries 2kT_k.
  simulation run = channel("2 mPa", {"space.reconstruction=upwind1", "space.limiter=none", "space.cells=4",
                                     "velocity.points=160", "time.steady=1e-5"});
  finish(run);
  const double root_1 = std::sqrt(350.0), root_2 = std::sqrt(300.0);
  const double n_root = 2.0 * number_density(run) * root_1 * root_2 / (root_1 + root_2);
  const double q = n_root * std::sqrt(k_B / (2.0 * pi * m_argon)) * 2.0 * k_B * (350.0 - 300.0);
  // The midpoint rule has an error Δv²/24 = 2.3e-4 at v = 0, where f jumps.
  EXPECT_NEAR(last_of(run, "flux_left_energy"), q, 1e-3 * q);
  EXPECT_NEAR(last_of(run, "flux_right_energy"), -q, 1e-3 * q);
}

TEST(gas_in_si_units, heat_flux_of_a_channel_is_fouriers_with_a_temperature_jump_at_high_pressure) {
  // q L = ∫ κ dT between the walls, over 1 + 2 ζ k, with κ = (5/2)(k/m) μ/Pr and k = μ√(2RT)/(pL). At each
  // wall Shakhov's model has the jump ζ k dT/dx with ζ = 1.95 (Sharipov, Rarefied Gas Dynamics, 2016). Terms
  // of size k² ≤ 2e-3 and the error of the mesh remain. Measured: 7e-4 and 1.9e-3.
  double before = 1.0;
  for (const char* pressure : {"20 kPa", "60 kPa"}) {
    simulation run = channel(pressure, {"space.cells=24", "velocity.points=24", "space.limiter=none",
                                        "time.cfl=0.5", "time.steady=1e-5"});
    finish(run);
    double integral = 0.0;
    for (int k = 0; k < 1000; ++k) integral += viscosity_of_argon(300.0 + 50.0 * (k + 0.5) / 1000.0) * 0.05;
    const double fourier = 2.5 * k_B / m_argon / (2.0 / 3.0) * integral / 1e-5;
    const double p = number_density(run) * k_B * 325.0;
    const double k = viscosity_of_argon(325.0) * std::sqrt(2.0 * k_B * 325.0 / m_argon) / (p * 1e-5);
    const double q = last_of(run, "flux_left_energy");
    EXPECT_NEAR(q * (1.0 + 2.0 * 1.95 * k) / fourier, 1.0, 4e-3) << pressure;
    EXPECT_LT(q, fourier);
    EXPECT_LT(1.0 - q / fourier, before / 2.0) << "no limit";
    before = 1.0 - q / fourier;
    // The cells at the walls do not resolve the Knudsen layer and are excluded.
    const auto inside = field_of(run, "heat_flux");
    for (std::size_t cell = 3; cell + 3 < inside.size(); ++cell) EXPECT_NEAR(inside[cell], q, 5e-3 * q);
  }
}

TEST(gas_in_si_units, results_are_those_of_the_dimensionless_run_times_scales) {
  const auto run_with = [](const std::string& units) {
    simulation run(load_case("gas/micro-channel", {"output.units=" + units, "time.end=100 ps",
                                                   "space.cells=12", "velocity.points=16"}));
    finish(run);
    return run;
  };
  const simulation si = run_with("SI"), plain = run_with("dimensionless");
  EXPECT_EQ(si.state(), plain.state());
  const double R = k_B / m_argon, speed = std::sqrt(R * 300.0), rho = 2000.0 / (R * 300.0);
  const std::vector<std::pair<std::string, double>> fields = {
      {"rho", rho}, {"T", 300.0}, {"p", 2000.0}, {"heat_flux", 2000.0 * speed}, {"knudsen", 1.0}};
  for (const auto& [name, unit] : fields) {
    const auto a = field_of(si, name), b = field_of(plain, name);
    for (std::size_t cell = 0; cell < a.size(); ++cell)
      EXPECT_NEAR(a[cell], b[cell] * unit, 1e-12 * std::abs(b[cell] * unit)) << name;
  }
  const std::vector<std::pair<std::string, double>> columns = {{"t", 1e-5 / speed},
                                                               {"dt", 1e-5 / speed},
                                                               {"step", 1.0},
                                                               {"min_value", 1.0},
                                                               {"total_mass", rho * 1e-5},
                                                               {"total_energy", 2000.0 * 1e-5},
                                                               {"received_left_momentum", rho * speed * 1e-5},
                                                               {"flux_left_momentum", 2000.0},
                                                               {"flux_right_energy", 2000.0 * speed}};
  for (const auto& [name, unit] : columns) {
    const double a = last_of(si, name), b = last_of(plain, name) * unit;
    EXPECT_NE(a, 0.0) << name;
    EXPECT_NEAR(a, b, 1e-12 * std::abs(b)) << name;
  }
  run_records records(si);
  records.add_snapshot(si);
  const solution written = make_solution(si, records);
  EXPECT_EQ(written.fields.labels.front(), "density (kg/m^3)");
  EXPECT_EQ(written.fields.units, (std::vector<std::string>{"kg/m^3", "K", "W/m^2", "Pa", "dimensionless"}));
  EXPECT_NEAR(written.t, 1e-10, 1e-24);
  EXPECT_NEAR(written.fields.axes.at(0).centres.back(), 1e-5 * 23.0 / 24.0, 1e-19);
  // A checkpoint is dimensionless, whatever the units of the results.
  EXPECT_EQ(to_csv(make_checkpoint(si, records).history),
            to_csv(make_checkpoint(plain, run_records(plain)).history));
}

const std::string wave = R"toml(
[model]
name = "bgk"
degrees_of_freedom = 3
epsilon = "0.02*(2 + cos(2*pi*x))"
[initial]
rho = "1 + 0.2*sin(2*pi*x)"
T = "1 + 0.1*cos(2*pi*x)"
[space]
cells = 40
domain = [0, 1]
formulation = "finite-difference"
[velocity]
max = 7
points = 24
[time]
method = "md-imex-6-3"
end = 0
safety = 1
[output]
fields = ["rho", "knudsen"]
)toml";

/// Returns the largest error of the local Knudsen number of a wave. `by_viscosity` selects the viscosity ε
/// T^exponent instead of Pr ε p.
double error_of_knudsen(const std::vector<std::string>& overrides, double prandtl, double exponent,
                        bool by_viscosity, int cells) {
  std::vector<std::string> all = overrides;
  all.push_back("space.cells=" + std::to_string(cells));
  const simulation run(parse_case(wave, "wave.toml", all));
  const auto values = field_of(run, "knudsen");
  double worst = 0.0;
  for (int cell = 0; cell < cells; ++cell) {
    const double x = (cell + 0.5) / cells;
    const double rho = 1.0 + 0.2 * std::sin(2.0 * pi * x), T = 1.0 + 0.1 * std::cos(2.0 * pi * x);
    const double epsilon = 0.02 * (2.0 + std::cos(2.0 * pi * x)), p = rho * T;
    const double mu = by_viscosity ? epsilon * std::pow(T, exponent) : prandtl * epsilon * p;
    const double exact = mu / p * std::sqrt(pi * T / 2.0) * std::abs(0.4 * pi * std::cos(2.0 * pi * x)) / rho;
    worst = std::max(worst, std::abs(values[static_cast<std::size_t>(cell)] - exact));
  }
  return worst;
}

TEST(local_knudsen, is_the_mean_free_path_over_the_length_of_the_density_gradient) {
  struct variant {
    std::vector<std::string> overrides;
    double prandtl, exponent;
    bool by_viscosity;
  };
  const std::vector<variant> variants = {
      {{}, 1.0, 0.0, false},
      {{"model.name=shakhov"}, 1.0, 0.0, false},
      {{"model.name=es-bgk", "model.prandtl=0.7"}, 0.7, 0.0, false},
      {{"model.collision_rate=viscosity", "model.viscosity_exponent=0.81"}, 1.0, 0.81, true},
      {{"model.name=es-bgk", "model.collision_rate=viscosity", "model.viscosity_exponent=0.7"},
       1.0,
       0.7,
       true}};
  for (const auto& [overrides, prandtl, exponent, by_viscosity] : variants) {
    const double coarse = error_of_knudsen(overrides, prandtl, exponent, by_viscosity, 40),
                 fine = error_of_knudsen(overrides, prandtl, exponent, by_viscosity, 80);
    // The derivative of a sine by central differences has a relative error (2πΔx)²/6. On 80 cells this is 1 %
    // of 0.1.
    EXPECT_LT(fine, 1e-4 * 2.0);
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.15);
  }
}

TEST(local_knudsen, is_one_sided_at_walls_and_zero_in_a_uniform_gas) {
  const simulation open(parse_case(wave, "wave.toml",
                                   {"space.boundary=outflow", "initial.rho=exp(x)", "initial.T=1",
                                    "model.epsilon=0.1", "space.cells=50"}));
  const auto values = field_of(open, "knudsen");
  for (const double kn : values)
    EXPECT_NEAR(kn, 0.1 * std::sqrt(pi / 2.0), 0.011 * 0.1 * std::sqrt(pi / 2.0));
  const simulation uniform(parse_case(wave, "wave.toml", {"initial.rho=2", "initial.T=1.5"}));
  for (const double kn : field_of(uniform, "knudsen")) EXPECT_LT(kn, 1e-13);
}

}  // namespace

}  // namespace gas_in_si_units_test
