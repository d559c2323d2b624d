// Initial data of the table [initial] as functions of the velocity: f, or g and h of a reduced gas.
#include <apsis/config/case.hpp>
#include <apsis/config/case_json.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/run/setup.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace initial_distribution_test {

namespace {

using apsis::field;
using apsis::parse_case;
using apsis::run_setup;

/// Returns a case on a line with cell averages, in which line 5 begins the table [initial].
std::string line(const std::string& initial, const std::string& model = "name = \"bgk\"") {
  return "[parameters]\nM = 2.0\n[model]\n" + model + "\n" + initial +
         "\n[space]\ncells = 12\ndomain = [0.0, 2.0]\n[velocity]\nmax = 9\npoints = 48\n"
         "[time]\nmethod = \"md-imex-3-2\"\nend = 0.1\ncfl = 0.05\n";
}

field state_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return run_setup(parse_case(text, "c.toml", overrides)).initial_state();
}

const std::string maxwellian = "exp(-v_x^2/2)/sqrt(2*pi)";

}  // namespace

TEST(initial_distribution, has_the_values_of_the_formula_at_every_velocity) {
  // The formula is linear in x, so averages are the values at the centres.
  for (const char* space : {"space.formulation=finite-volume", "space.formulation=finite-difference"}) {
    const run_setup setup(
        parse_case(line("[initial]\nf = \"(1 + x + M*v_x^2)*" + maxwellian + "\""), "c.toml", {space}));
    const field u = setup.initial_state();
    const auto v = setup.equation->speeds(0);
    for (int cell = 0; cell < u.cells(); ++cell)
      for (std::size_t j = 0; j < v.size(); ++j) {
        const double wanted = (1.0 + setup.mesh().centre(cell, 0) + 2.0 * v[j] * v[j]) *
                              std::exp(-0.5 * v[j] * v[j]) / std::sqrt(2.0 * std::numbers::pi);
        EXPECT_NEAR(u.row(cell)[j], wanted, 1e-14 * wanted + 1e-300);
      }
  }
}

TEST(initial_distribution, is_averaged_over_cells_that_an_edge_of_a_region_cuts) {
  const std::string text = line("[initial]\nf = \"" + maxwellian +
                                "\"\n[[initial.region]]\nwhere = \"x < 0.75\"\n"
                                "f = \"3*" +
                                maxwellian + "\"\n");
  const field u = state_of(text), below = state_of(line("[initial]\nf = \"" + maxwellian + "\""));
  for (int k = 0; k < u.components(); ++k) {
    EXPECT_NEAR(u.row(0)[k], 3.0 * below.row(0)[k], 1e-14 * u.row(0)[k] + 1e-300);
    EXPECT_NEAR(u.row(4)[k], 2.0 * below.row(4)[k], 1e-14 * u.row(4)[k] + 1e-300);  // the edge is its middle
    EXPECT_NEAR(u.row(5)[k], below.row(5)[k], 1e-14 * u.row(5)[k] + 1e-300);
  }
}

TEST(initial_distribution, of_a_reduced_gas_is_integrated_over_the_other_velocities) {
  for (const char* model : {"bgk", "shakhov", "es-bgk"}) {
    const std::string name = fmt::format("name = \"{}\"\ndegrees_of_freedom = 3", model);
    const field by_functions = state_of(
                    line("[initial]\ng = \"" + maxwellian + "\"\nh = \"2*" + maxwellian + "\"", name)),
                by_variables = state_of(line("[initial]\nrho = 1\nT = 1", name));
    for (int k = 0; k < by_functions.components();
         ++k)  // the discrete Maxwellian is within 1e-12 of the formula
      EXPECT_NEAR(by_functions.row(3)[k], by_variables.row(3)[k], 1e-11) << model;
  }
}

TEST(initial_distribution, is_a_function_of_every_component_and_coordinate) {
  const std::string text =
      "[model]\nname = \"bgk\"\nvelocity_dimensions = 3\n[initial]\nf = \"(1 + 0.1*x + 0.2*y + 0.01*v_x + "
      "0.02*v_y + 0.03*v_z)*exp(-(v_x^2 + v_y^2 + v_z^2)/2)\"\n[space]\ncells = [5, 6]\nreconstruction = "
      "\"upwind1\"\n[velocity]\nmax = 7\npoints = [8, 10, 12]\n[time]\nmethod = \"md-imex-3-2\"\nend = "
      "0.1\ncfl = 0.05\n";
  const run_setup setup(parse_case(text, "c.toml"));
  const field u = setup.initial_state();
  const auto v = [&](int k, int j) { return setup.equation->speeds(k)[static_cast<std::size_t>(j)]; };
  for (int cell = 0; cell < u.cells(); cell += 7)
    for (int j = 0; j < u.components(); j += 11) {
      const auto x = setup.mesh().centre(cell);
      const double square = v(0, j) * v(0, j) + v(1, j) * v(1, j) + v(2, j) * v(2, j);
      const double wanted =
          (1.0 + 0.1 * x[0] + 0.2 * x[1] + 0.01 * v(0, j) + 0.02 * v(1, j) + 0.03 * v(2, j)) *
          std::exp(-0.5 * square);
      EXPECT_NEAR(u.row(cell)[j], wanted, 1e-13 * wanted);
    }
}

TEST(initial_distribution, is_a_term_of_a_sum) {
  const std::string part = "[[initial.part]]\nweight = 0.5\nf = \"" + maxwellian + "\"\n";
  const field sum = state_of(line(part + "[[initial.part]]\nrho = 2\nu = 1\nT = 0.5\n")),
              f = state_of(line("[initial]\nf = \"" + maxwellian + "\"")),
              beam = state_of(line("[initial]\nrho = 2\nu = 1\nT = 0.5"));
  for (int k = 0; k < sum.components(); ++k) {
    const double wanted = 0.5 * f.row(2)[k] + beam.row(2)[k];
    EXPECT_NEAR(sum.row(2)[k], wanted, 1e-14 * wanted + 1e-300);
  }
}

TEST(initial_distribution, is_written_with_the_case_and_read_back) {
  const auto c = parse_case(line("[initial]\nf = \"(1 + 0.1*x)*" + maxwellian + "\""), "c.toml");
  const auto again = parse_case(to_toml(c), "again.toml");
  EXPECT_EQ(to_toml(again), to_toml(c));
  const field u = run_setup(c).initial_state(), same = run_setup(again).initial_state();
  for (int k = 0; k < u.components(); ++k) EXPECT_EQ(u.row(5)[k], same.row(5)[k]);
  EXPECT_EQ(to_json(c)["initial"]["f"].get<std::string>(), "(1 + 0.1*x)*" + maxwellian);
}

TEST(initial_distribution, is_dimensionless_also_in_the_units_of_a_gas) {
  const std::string argon =
      "[gas]\nname = \"argon\"\npressure = \"2 kPa\"\ntemperature = \"300 K\"\nlength = \"10 "
      "um\"\n[model]\nname = "
      "\"shakhov\"\n[initial]\ng = \"" +
      maxwellian + "\"\nh = \"2*" + maxwellian +
      "\"\n[space]\ncells = 10\ndomain = [0, \"10 um\"]\n[velocity]\nmax = 8\npoints = 40\n[time]\nmethod = "
      "\"md-imex-3-2\"\nend = 1\nsafety = 0.5\n";
  const run_setup setup(parse_case(argon, "c.toml"));
  const field u = setup.initial_state();
  std::vector<double> fields(setup.equation->default_fields().size());
  setup.equation->macroscopic(u.row(4), fields.data());
  EXPECT_NEAR(fields[0], 1.0, 1e-12);
  EXPECT_NEAR(fields[2], 1.0, 1e-12);
}

}  // namespace initial_distribution_test
