// Runs with tables in time, ends of given mass flux, walls without a given temperature, and profiles from
// earlier results.
#include "cases_in_space.hpp"

#include <apsis/config/case.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/run/session.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>
#include <support/folder.hpp>

namespace ends_of_flows_test {

namespace {

using namespace apsis;
using testing::HasSubstr;

const std::string line = R"toml(
[model]
name = "bgk"
degrees_of_freedom = 3
epsilon = 0.1
[initial]
rho = 1
T = 1
[space]
cells = 16
formulation = "finite-difference"
limiter = "positivity"
[velocity]
max = 8
points = 24
[time]
method = "md-imex-6-3"
safety = 1
end = 0.1
)toml";

simulation run_of(const std::string& text, const std::vector<std::string>& more = {}) {
  simulation run(parse_case(text, "flow.toml", more));
  while (!run.finished()) run.advance();
  return run;
}

/// Returns the flux of an invariant through an open face. The last invariant is the energy.
double flux_of(const simulation& run, std::size_t face, std::size_t invariant) {
  const std::size_t count = run.setup().equation->invariants().size();
  return run.last().flux.at(face * count + invariant);
}

void expect_promises(const simulation& run) {
  EXPECT_LT(run.summary().conservation_defect, 1e-12);
  EXPECT_EQ(run.summary().negative_values, 0);
}

}  // namespace

TEST(ends_of_flows, of_given_flux_have_it_in_every_formulation_and_model) {
  const std::string ends =
      "[boundary.left]\nkind = \"mass-flow\"\nflux = 0.25\nT = 1.1\n"
      "[boundary.right]\nkind = \"mass-flow\"\nflux = -0.15\n";
  for (const char* model : {"bgk", "shakhov", "es-bgk"})
    for (const char* formulation : {"finite-difference", "finite-volume"})
      for (const char* epsilon : {"1e-5", "0.1", "10"}) {
        const simulation run = run_of(
            line + ends, {fmt::format("model.name={}", model), fmt::format("model.epsilon={}", epsilon),
                          fmt::format("space.formulation={}", formulation)});
        // The flux is a sum of some ten terms of size 1 in each of 6 stages.
        EXPECT_NEAR(flux_of(run, 0, 0), 0.25, 1e-13) << model << formulation << epsilon;
        EXPECT_NEAR(flux_of(run, 1, 0), -0.15, 1e-13) << model << formulation << epsilon;
        EXPECT_LT(run.summary().conservation_defect, 1e-12);
        if (std::string(model) != "shakhov") expect_promises(run);
      }
}

TEST(ends_of_flows, whose_flux_is_not_reached_are_named_once) {
  testing::internal::CaptureStderr();
  const simulation run = run_of(line +
                                "[boundary.right]\nkind = \"mass-flow\"\nflux = -3\n"
                                "[boundary.left]\nkind = \"diffuse\"\n");
  const std::string messages = testing::internal::GetCapturedStderr();
  EXPECT_GT(flux_of(run, 1, 0), -3.0);
  EXPECT_LT(flux_of(run, 1, 0), -0.2);
  const std::string wanted = "less gas arrives at [boundary.right] than its flux lets out";
  const auto first = messages.find(wanted);
  EXPECT_NE(first, std::string::npos) << messages;
  EXPECT_EQ(messages.find(wanted, first + 1), std::string::npos) << messages;
  expect_promises(run);
}

TEST(ends_of_flows, with_tables_in_time_are_those_of_their_formulas) {
  const auto with = [](const std::string& T) {
    return run_of(line + fmt::format("[boundary.left]\nkind = \"diffuse\"\nT = \"{}\"\n"
                                     "[boundary.right]\nkind = \"diffuse\"\n",
                                     T));
  };
  const auto table = with("table(t, 0, 1, 0.05, 1.5, 0.08, 1.2)").state(),
             formula = with("t < 0.05 ? 1 + 10*t : (t < 0.08 ? 1.5 - 10*(t - 0.05) : 1.2)").state();
  double most = 0.0;
  for (std::size_t k = 0; k < table.size(); ++k) most = std::max(most, std::abs(table[k] - formula[k]));
  EXPECT_LT(most, 1e-13);
}

TEST(ends_of_flows, at_walls_without_a_given_temperature_balance_heat) {
  for (const char* model : {"bgk", "shakhov", "es-bgk"})
    for (const char* formulation : {"finite-difference", "finite-volume"}) {
      const simulation run =
          run_of(line +
                     "[boundary.left]\nkind = \"adiabatic\"\naccommodation = 0.8\n[boundary.right]\nkind = "
                     "\"diffuse\"\nT "
                     "= 1.4\n",
                 {fmt::format("model.name={}", model), fmt::format("space.formulation={}", formulation)});
      EXPECT_NEAR(flux_of(run, 0, 0), 0.0, 1e-13);
      EXPECT_NEAR(flux_of(run, 0, 2), 0.0, 1e-13);
      EXPECT_GT(flux_of(run, 1, 2), 1e-2);
    }
  // Between a radiating plate and a warm one, the steady heat flux equals the radiation of the plate.
  const simulation run = run_of(line +
                                    "[boundary.left]\nkind = \"radiating\"\nsigma = 0.3\nsurroundings = 0.8\n"
                                    "[boundary.right]\nkind = \"diffuse\"\nT = 1.4\n[steady]\n",
                                {"velocity.points=16", "space.cells=8"});
  const double heat = -flux_of(run, 0, 2), T = std::pow(heat / 0.3 + std::pow(0.8, 4), 0.25);
  EXPECT_NEAR(heat, flux_of(run, 1, 2), 1e-6);
  const simulation fixed =
      run_of(line + fmt::format("[boundary.left]\nkind = \"diffuse\"\nT = {}\n"
                                "[boundary.right]\nkind = \"diffuse\"\nT = 1.4\n[steady]\n",
                                T),
             {"velocity.points=16", "space.cells=8"});
  EXPECT_NEAR(-flux_of(fixed, 0, 2), heat, 1e-6);
}

TEST(ends_of_flows, of_given_flux_and_pressure_settle) {
  const simulation run =
      run_of(line +
                 "[boundary.left]\nkind = \"mass-flow\"\nflux = 0.2\n[boundary.right]\nkind = "
                 "\"pressure\"\np = 1\n[steady]\n",
             {"velocity.points=16", "space.cells=8"});
  EXPECT_NEAR(flux_of(run, 0, 0), 0.2, 1e-8);
  EXPECT_NEAR(flux_of(run, 1, 0), -0.2, 1e-6);
}

namespace {

const std::string plane = R"toml(
[model]
name = "bgk"
velocity_dimensions = 2
degrees_of_freedom = 3
epsilon = 0.1
[initial]
rho = "1 + 0.1*y + 0.1*x"
u = ["0.2 + 0.1*y", 0]
T = "1 + 0.2*y*(1 - y)"
[space]
cells = [6, 5]
boundary = "outflow"
limiter = "positivity"
[velocity]
max = 7
points = 12
[time]
method = "md-imex-6-3"
safety = 1
end = 0.01
)toml";

void read(const std::string& text) {
  parse_case(text, "c.toml");
}

}  // namespace

TEST(ends_of_flows, take_profiles_in_space_from_earlier_results) {
  // A solid box covers a part of the right side. Its cells get the values of the nearest gas.
  const std::string text =
      in_several_dimensions::in_space + "[[space.solid]]\nfrom = [0.75, 0, 0]\nto = [1, \"2/7\", \"4/9\"]\n";
  const test_folder folder;
  in_several_dimensions::run_into(folder / "earlier", text, {"output.fields=[]"});
  const std::string inlet =
      fmt::format("[boundary.left]\nkind = \"inflow\"\nprofile = {{ file = \"{}\", side = \"right\" }}\n",
                  folder / "earlier/solution.h5");
  const case_config config = parse_case(text + inlet, "c.toml", {"output.fields=[]"});
  const auto earlier = run_of(text).fields();
  const grid mesh = make_mesh(config);
  const auto& values = config.faces[0].values;
  ASSERT_EQ(values.at("u").size(), 3U);
  const expression rho(values.at("rho").front(), {}, formula_of_position(3, false)),
      T(values.at("T").front(), {}, formula_of_position(3, false));
  const auto last_cell = [](int j, int k) { return (7 * 7 + j) * 9 + k; };
  const auto value_at = [&](const expression& of, int j, int k) {
    return of.value(mesh.centre(last_cell(j, k)));
  };
  const auto of_cell = [&](const std::string& name, int j, int k) {
    const auto found = std::find(earlier.names.begin(), earlier.names.end(), name) - earlier.names.begin();
    return earlier.values.at(static_cast<std::size_t>(found)).at(static_cast<std::size_t>(last_cell(j, k)));
  };
  for (int j = 0; j < 7; ++j)
    for (int k = 0; k < 9; ++k) {
      if (j < 2 && k < 2) continue;
      EXPECT_EQ(value_at(rho, j, k), of_cell("rho", j, k)) << j << " " << k;
      EXPECT_EQ(value_at(T, j, k), of_cell("T", j, k)) << j << " " << k;
    }
  // Cells have the sizes 1/7 along y and 2/9 along z, so the gas beyond the box in y is nearer.
  EXPECT_EQ(value_at(rho, 1, 0), of_cell("rho", 2, 0));
  EXPECT_EQ(value_at(rho, 0, 1), of_cell("rho", 0, 2));
  EXPECT_EQ(to_toml(parse_case(to_toml(config), "again")), to_toml(config));
  expect_promises(run_of(to_toml(config)));
  bad_input::expect_refused({
      {[&] { read(in_several_dimensions::in_plane + inlet); },
       {"it has 3 space dimensions (the case has 2); give another result"}},
  });
}

TEST(ends_of_flows, take_profiles_from_earlier_results) {
  const test_folder folder;
  session_options how;
  how.out = folder / "earlier";
  run_session(parse_case(plane, "earlier.toml"), how).run();
  const std::string file = folder / "earlier/solution.h5";
  const auto with = [&](const std::string& more) {
    return plane +
           fmt::format("[boundary.left]\nkind = \"inflow\"\nprofile = {{ file = \"{}\"{} }}\n", file, more);
  };
  const case_config config = parse_case(with(", side = \"right\""), "c.toml");
  const auto& rho = config.faces[0].values.at("rho").front();
  EXPECT_THAT(rho, testing::StartsWith("table(y, 0.1, "));
  ASSERT_EQ(config.faces[0].values.at("u").size(), 2U);
  // The profile has the values in the cells at x = 11/12 of the earlier result.
  const simulation earlier = run_of(plane);
  const auto fields = earlier.fields();
  EXPECT_THAT(rho, HasSubstr(fmt::format("0.1, {}, ", fields.values.front().at(25))));
  EXPECT_EQ(to_toml(parse_case(to_toml(config), "again")), to_toml(config));
  expect_promises(run_of(to_toml(config)));
  EXPECT_NE(parse_case(with(""), "c.toml").faces[0].values.at("rho").front(), rho);
  bad_input::expect_refused({
      {[&] { read(with(", side = \"top\"")); },
       {"'boundary.left.profile.side' is the text 'top' (it has another direction than the face); "
        "give left or right"}},
      {[&] { read(with(", side = \"rigt\"")); },
       {"unknown side 'rigt' (no face has this name); did you "
        "mean 'right'?"}},
      {[&] { read(with("") + "rho = 1\n"); }, {"conflicts with 'boundary.left.rho' (both give the value)"}},
      {[&] {
         read(line + fmt::format("[boundary.left]\nkind = \"inflow\"\nprofile.file = \"{}\"\n"
                                 "[boundary.right]\nkind = \"outflow\"\n",
                                 file));
       },
       {"it has 2 space dimensions (the case has 1); give another result"}},
      {[&] { read(plane + "[boundary.left]\nkind = \"inflow\"\nprofile.file = \"nowhere.h5\"\n"); },
       {"c.toml:24:9: 'boundary.left.profile.file' = \"nowhere.h5\" cannot be used: "}},
  });
}

}  // namespace ends_of_flows_test
