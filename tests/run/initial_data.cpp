// Initial data of the table [initial]: values, and averages across the edges of regions.
#include <apsis/config/case.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/run/setup.hpp>

#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace initial_data_test {

namespace {

using apsis::field;
using apsis::input_error;
using apsis::parse_case;
using apsis::run_setup;

/// Returns a case in which line 5 begins the table [initial].
std::string gas(const std::string& initial, const std::string& model = "name = \"bgk\"") {
  return "[parameters]\nM = 2.0\n[model]\n" + model + "\n" + initial +
         "\n[space]\ncells = 12\ndomain = [0.0, 2.0]\n[velocity]\nmax = 9\npoints = 48\n"
         "[time]\nmethod = \"md-imex-3-2\"\nend = 0.1\ncfl = 0.05\n";
}

std::string without_velocities(std::string text) {
  return text.erase(text.find("[velocity]"), text.find("[time]") - text.find("[velocity]"));
}

field state_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return run_setup(parse_case(text, "c.toml", overrides)).initial_state();
}

/// Returns macroscopic field number k of every cell.
std::vector<double> fluid(const std::string& text, std::size_t k) {
  const run_setup setup(parse_case(text, "c.toml"));
  const field u = setup.initial_state();
  std::vector<double> values(setup.equation->default_fields().size()), out;
  for (int cell = 0; cell < u.cells(); ++cell) {
    setup.equation->macroscopic(u.row(cell), values.data());
    out.push_back(values[k]);
  }
  return out;
}

void expect_close(const field& a, const field& b, double relative) {
  ASSERT_EQ(a.cells(), b.cells());
  ASSERT_EQ(a.components(), b.components());
  for (int cell = 0; cell < a.cells(); ++cell)
    for (int k = 0; k < a.components(); ++k)
      EXPECT_NEAR(a.row(cell)[k], b.row(cell)[k], relative * std::abs(b.row(cell)[k]) + 1e-300)
          << "cell " << cell << ", component " << k;
}

}  // namespace

TEST(prescribed_data, as_a_sum_of_maxwellians_equal_the_named_data_of_the_paper) {
  const std::string T = "T = \"1/(1 + 0.2*sin(2*pi*x))\"\n", rho = "rho = \"1 + 0.2*sin(pi*x)\"\n";
  const std::string sum = "[[initial.part]]\nweight = 0.5\n" + rho + "u = 1\n" + T +
                          "[[initial.part]]\nweight = 0.3\n" + rho + "u = -0.5\n" + T;
  const std::vector<std::string> grid = {"velocity.max=15", "velocity.points=150"};
  // T follows from moments with a rounding error of a few 1e-16. The exponents, up to 128/0.8, amplify it.
  expect_close(state_of(gas(sum), grid), state_of(gas(""), grid), 1e-12);
}

TEST(prescribed_data, of_other_models_equal_their_named_data_bit_for_bit) {
  const auto broadwell = [](const std::string& initial, const std::string& name) {
    return without_velocities(gas(initial, "name = \"broadwell\"" + name));
  };
  expect_close(
      state_of(broadwell("[initial]\nrho = 2\nm = 1\nz = 1\n[[initial.region]]\nwhere = \"x >= 0.2\"\nrho = "
                         "1\nm = 0.13962\n",
                         "")),
      state_of(broadwell("", "\ninitial = \"riemann-1\"")), 0.0);
  const auto relaxation = [](const std::string& initial, const std::string& name) {
    return without_velocities(gas(initial, "name = \"relaxation\"" + name));
  };
  expect_close(
      state_of(relaxation("[initial]\nu1 = 0.9\n[[initial.region]]\nwhere = \"x >= 0.7\"\nu1 = 0.1\n", "")),
      state_of(relaxation("", "\ninitial = \"riemann\"\nleft = 0.9\nright = 0.1\njump = 0.7")), 0.0);
  const std::string ode =
      "[model]\nname = \"ode\"\n[initial]\nu1 = 2\n[time]\nmethod = \"md-imex-3-2\"\nend = 1\ndt = 0.1\n";
  EXPECT_EQ(state_of(ode).row(0)[1], std::sin(2.0));
  EXPECT_EQ(state_of(ode, {"initial.u2=0.25"}).row(0)[1], 0.25);
}

TEST(prescribed_data, have_the_given_moments_to_rounding_also_on_a_coarse_velocity_grid) {
  for (const char* points : {"velocity.points=20", "velocity.points=48"}) {
    const run_setup setup(parse_case(gas("[initial]\nrho = \"M\"\nu = 0.25\nT = 0.7"), "c.toml", {points}));
    double values[5];
    setup.equation->macroscopic(setup.initial_state().row(5), values);
    EXPECT_NEAR(values[0], 2.0, 1e-14) << points;  // sums of up to 48 terms
    EXPECT_NEAR(values[1], 0.25, 1e-14) << points;
    EXPECT_NEAR(values[2], 0.7, 1e-14) << points;
  }
}

TEST(prescribed_data, have_one_velocity_component_per_dimension) {
  const std::string plane = "name = \"bgk\"\nvelocity_dimensions = 2";
  const std::string given = gas("[initial]\nrho = 1\nu = [\"0.1*x\", -0.2]\nT = 1", plane);
  const std::string alone = gas("[initial]\nrho = 1\nu = \"0.1*x\"\nT = 1", plane);
  for (int cell = 0; cell < 12; ++cell) {
    const auto k = static_cast<std::size_t>(cell);
    EXPECT_NEAR(fluid(given, 1)[k], 0.1 * (cell + 0.5) / 6.0, 1e-14);  // averages of a linear function
    EXPECT_NEAR(fluid(given, 2)[k], -0.2, 1e-14);
    EXPECT_NEAR(fluid(alone, 2)[k], 0.0, 1e-14);
  }
}

RC_GTEST_PROP(prescribed_data, have_exact_averages_in_cells_that_an_edge_of_a_region_cuts, ()) {
  const double edge = 2.0 * (*rc::gen::inRange(1, 100000)) / 100000.0;
  const double width = (*rc::gen::inRange(2, 100000)) / 100000.0;
  const std::string text =
      gas(fmt::format("[initial]\nrho = 1\nT = 1\n[[initial.region]]\nwhere = \"x > {} && x < {}\"\nrho = 3",
                      edge, edge + width));
  std::vector<double> rho;
  try {
    rho = fluid(text, 0);
  } catch (const input_error& missed) {  // too thin for the points that search for regions
    RC_ASSERT(width < 1.0 / 6.0 / 32.0 || edge > 1.99);
    RC_DISCARD("too thin");
  }
  if (width < 1.0 / 6.0 / 32.0) RC_DISCARD("too thin");
  for (int cell = 0; cell < 12; ++cell) {
    const double left = cell / 6.0, right = (cell + 1) / 6.0;
    const double inside = std::max(0.0, std::min(right, edge + width) - std::max(left, edge));
    // The edge is exact to an ulp of x, relative to a cell of 1/6. The averages are sums of 20 points.
    RC_ASSERT(std::abs(rho[static_cast<std::size_t>(cell)] - (1.0 + 2.0 * inside * 6.0)) < 2e-14);
  }
}

TEST(prescribed_data, of_regions_lie_on_top_of_each_other) {
  const std::string text =
      gas("[initial]\nrho = 1\nu = 0.5\nT = 1\n"
          "[[initial.region]]\nwhere = \"x > 0.5\"\nrho = \"M\"\n"
          "[[initial.region]]\nwhere = \"x > 1\"\nT = 0.5\n"
          "[[initial.region]]\nwhere = \"x > 1.5\"\n[[initial.region.part]]\nrho = 1\nT = 1\n"
          "[[initial.region.part]]\nweight = 3\nrho = 1\nT = 1\n");
  const auto rho = fluid(text, 0), u = fluid(text, 1), T = fluid(text, 2);
  const auto expect = [&](std::size_t cell, double density, double velocity, double temperature) {
    EXPECT_NEAR(rho[cell], density, 1e-13);
    EXPECT_NEAR(u[cell], velocity, 1e-13);
    EXPECT_NEAR(T[cell], temperature, 1e-13);
  };
  expect(0, 1.0, 0.5, 1.0);
  expect(4, 2.0, 0.5, 1.0);
  expect(7, 2.0, 0.5, 0.5);
  expect(11, 4.0, 0.0, 1.0);
}

TEST(prescribed_data, are_written_with_the_case_and_read_back) {
  const std::string text =
      gas("[initial]\nrho = \"1 + 0.1*sin(pi*x)\"\nu = 1\nT = 1\n"
          "[[initial.region]]\nwhere = \"x > 1\"\n[[initial.region.part]]\nweight = \"M\"\nrho = 1\nT = 2\n");
  const auto c = parse_case(
      text, "c.toml", {"initial.region.2.where=x < 0.2", "initial.region.2.T=M/4", "initial.region.2.rho=1"});
  const std::string resolved = apsis::to_toml(c);
  const auto again = parse_case(resolved, "again.toml");
  EXPECT_EQ(apsis::to_toml(again), resolved);
  expect_close(run_setup(again).initial_state(), run_setup(c).initial_state(), 0.0);
  ASSERT_EQ(again.prescribed.regions.size(), 2U);
  EXPECT_EQ(again.prescribed.regions[1].state.at("T").front(), "M/4");
  EXPECT_EQ(again.constants.at("M"), 2.0);
}

TEST(parameters, are_constants_of_every_formula) {
  const std::string text = gas("[initial]\nrho = \"M\"\nT = \"M/2\"", "name = \"bgk\"\nepsilon = \"1e-3*M\"");
  EXPECT_EQ(run_setup(parse_case(text, "c.toml")).epsilon_at_centres().front(), 2e-3);
  EXPECT_EQ(run_setup(parse_case(text, "c.toml", {"parameters.M=1/4"})).epsilon_at_centres().front(),
            0.25e-3);
  const std::string flux =
      without_velocities(gas("[initial]\nu1 = 0.5", "name = \"relaxation\"\nflux = \"M*u^2/4\""));
  EXPECT_EQ(state_of(flux).row(0)[0], 0.5 * (0.5 + 0.125));
}

}  // namespace initial_data_test
