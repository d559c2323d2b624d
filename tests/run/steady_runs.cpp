// Cases with a table [steady] have the same flows as in time, after tens of iterations.
#include <apsis/config/case.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/run/records.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace steady_runs_test {
namespace {

using apsis::simulation;
using testing::HasSubstr;
using keys = std::vector<std::string>;

simulation found(const std::string& name, keys more) {
  more.emplace_back("steady.tolerance=1e-8");
  simulation run(apsis::load_case(name, more));
  while (!run.finished()) run.advance();
  return run;
}

void end_of(const std::string& name, const keys& more) {
  simulation run(apsis::load_case(name, more));
  while (!run.finished()) run.advance();
}

/// A flow of cases/gas and the largest number of iterations allowed. Flows in the plane and in space are
/// small versions.
struct flow {
  const char* name;
  keys more;
  long most;
};
void PrintTo(const flow& of, std::ostream* out) {
  *out << of.name << " " << testing::PrintToString(of.more);
}

class shipped_flows : public testing::TestWithParam<flow> {};

std::vector<flow> all_flows() {
  std::vector<flow> all;
  for (const char* line : {"gas/couette", "gas/fourier", "gas/poiseuille"})
    for (const char* delta : {"0.01", "0.1", "1", "10", "100", "1000"})
      all.push_back({line, {std::string("parameters.delta=") + delta}, 60});
  all.push_back({"gas/kramers", {}, 60});
  all.push_back({"gas/micro-channel", {}, 60});
  all.push_back({"gas/evaporation", {}, 60});
  const keys small = {"space.cells=[12, 12]", "velocity.points=10"};
  for (const char* delta : {"0.1", "1", "10", "100", "1000"}) {
    keys more = small;
    more.push_back(std::string("parameters.delta=") + delta);
    all.push_back({"gas/cavity", more, 120});
    all.push_back({"gas/thermal-cavity", more, 120});
  }
  all.push_back({"gas/enclosure", {"space.cells=[8, 12]", "velocity.points=12"}, 120});
  all.push_back({"gas/transpiration", {"space.cells=[20, 8]", "velocity.points=12"}, 120});
  all.push_back({"gas/duct", {"space.cells=[6, 6]", "velocity.points=[8, 8, 8]"}, 120});
  for (const char* delta : {"0.01", "0.1", "1", "10", "100", "1000"})
    all.push_back({"gas/annulus", {std::string("parameters.delta=") + delta, "space.cells=12"}, 80});
  const keys ball = {"space.cells=[18, 8]", "velocity.points=12", "velocity.rings=6", "velocity.angles=12"};
  for (const char* mach : {"0.2", "2"}) {
    keys more = ball;
    more.push_back(std::string("parameters.M=") + mach);
    more.emplace_back("space.limiter=positivity");
    all.push_back({"gas/sphere-axis", more, 120});
  }
  return all;
}

/// A cylinder of gas about the axis.
const char* const cylinder_of_gas =
    "[model]\nname = \"bgk\"\nepsilon = 0.05\n[initial]\nrho = 1\nT = 1\n[space]\ngeometry = "
    "\"axisymmetric\"\n"
    "cells = 10\ndomain = [0, 1]\n[boundary.right]\nkind = \"diffuse\"\nT = 1\n[velocity]\nmax = 6\npoints = "
    "10\n"
    "rings = 8\nangles = 12\n[steady]\ntolerance = 1e-9\n[output]\nevery = 0\n";

std::string with_wall(const std::string& wall) {
  std::string text = cylinder_of_gas;
  const std::string usual = "T = 1\n[velocity]";
  return text.replace(text.find(usual), usual.size(), wall + "\n[velocity]");
}

}  // namespace

TEST_P(shipped_flows, settle_in_tens_of_iterations) {
  const auto& [name, more, most] = GetParam();
  const simulation run = found(name, more);
  EXPECT_LE(run.step(), most);
  EXPECT_LE(run.last().residual.front(), 1e-8);
  EXPECT_LE(run.last().change, 1e-8);
  // The net rates vanish, in units of the content of the gas and the crossing time of a molecule.
  for (const double rate : run.last().conservation_defect) EXPECT_LT(rate, 1e-7);
}

INSTANTIATE_TEST_SUITE_P(gases, shipped_flows, testing::ValuesIn(all_flows()));

TEST(steady_run, about_an_axis_leaves_a_gas_at_rest_as_it_is) {
  simulation run(apsis::parse_case(cylinder_of_gas, "gas.toml"));
  const auto before = run.state();
  while (!run.finished()) run.advance();
  EXPECT_EQ(run.step(), 1);
  const auto after = run.state();
  // The start solves the equation to rounding, of some ten terms of size 1.
  for (std::size_t k = 0; k < after.size(); ++k) ASSERT_NEAR(after[k], before[k], 1e-13);
}

TEST(steady_run, about_an_axis_turns_with_the_wall_like_a_rigid_body) {
  simulation run(apsis::parse_case(with_wall("T = 1\nvelocity = [0, 0.05, 0]"), "gas.toml"));
  while (!run.finished()) run.advance();
  const auto fields = run.fields();
  const auto found = std::find(fields.names.begin(), fields.names.end(), "u_y");
  ASSERT_NE(found, fields.names.end());
  const auto& swirl = fields.values[static_cast<std::size_t>(found - fields.names.begin())];
  for (int cell = 0; cell < 10; ++cell) {
    const double r = (cell + 0.5) / 10;
    // Solid-body rotation is an equilibrium, exact for the equation. The mesh of 10 cells and the rings give
    // an error of 1e-4 of the speed of the wall.
    EXPECT_NEAR(swirl[static_cast<std::size_t>(cell)], 0.05 * r, 1e-4) << cell;
  }
}

TEST(steady_run, about_an_axis_has_the_state_of_steps_in_time) {
  const keys small = {"space.cells=8", "velocity.points=8", "velocity.rings=6", "velocity.angles=12"};
  const simulation steady = found("gas/annulus", small);
  keys more = small;
  for (const char* one :
       {"time.method=ars-443", "time.end=200", "space.reconstruction=upwind5", "space.limiter=none"})
    more.emplace_back(one);
  simulation in_time(apsis::load_case("gas/annulus", more));
  while (!in_time.finished()) in_time.advance();
  const auto a = steady.state(), b = in_time.state();
  // This method has the steady states of the equation. A residual of 1e-8 leaves differences of 1e-11.
  for (std::size_t k = 0; k < a.size(); ++k) ASSERT_NEAR(a[k], b[k], 1e-10) << k;
}

TEST(steady_run, about_an_axis_is_nonnegative_with_the_limiter) {
  const keys hot = {"space.limiter=positivity", "parameters.heat=3", "velocity.max=12", "velocity.points=24",
                    "space.cells=12"};
  const simulation run = found("gas/annulus", hot);
  EXPECT_GE(run.last().min_value, 0.0);
  EXPECT_EQ(run.last().negative_values, 0);
  keys unlimited = hot;
  unlimited.front() = "space.limiter=none";
  EXPECT_LT(found("gas/annulus", unlimited).last().min_value, 0.0);
}

TEST(steady_run, counts_iterations_in_its_history) {
  const simulation run = found("gas/couette", {"space.cells=8"});
  EXPECT_EQ(run.t(), static_cast<double>(run.step()));
  EXPECT_EQ(run.summary().steps, run.step());
  EXPECT_TRUE(std::isnan(run.initial_record().residual.front()));
  const apsis::run_records records(run);
  EXPECT_THAT(records.history().columns, testing::Contains("residual_relative"));
  const simulation in_time(apsis::load_case("gas/couette", {"space.cells=8"}));
  EXPECT_THAT(apsis::run_records(in_time).history().columns,
              testing::Not(testing::Contains("residual_relative")));
}

TEST(steady_run, has_the_fluxes_of_its_state) {
  const simulation run = found("gas/fourier", {"space.cells=10"});
  const auto& flux = run.last().flux;  // left mass, momentum, energy; right
  EXPECT_GT(std::abs(flux[2]), 5e-4);
  EXPECT_NEAR(flux[2], -flux[5], 1e-8 * std::abs(flux[2]) + 1e-12);
  EXPECT_NEAR(flux[0], 0.0, 1e-14);
}

TEST(steady_run, continues_after_a_checkpoint_with_the_same_unit_of_residuals) {
  const auto config = apsis::load_case("gas/couette", {"space.cells=8", "steady.tolerance=1e-10"});
  simulation whole(config);
  while (!whole.finished()) whole.advance();
  simulation first(config);
  for (int n = 0; n < 6; ++n) first.advance();
  simulation second(config);
  second.restore(first.save());
  while (!second.finished()) second.advance();
  EXPECT_LE(second.last().residual.front(), 1e-10);
  EXPECT_LE(second.step(), whole.step() + 8);  // the mixture forgets its images
  const auto a = whole.state(), b = second.state();
  for (std::size_t k = 0; k < a.size(); ++k) ASSERT_NEAR(a[k], b[k], 1e-9);
}

TEST(steady_run, is_written_and_read_as_a_case) {
  const auto config = apsis::load_case("gas/cavity", {"steady.iterations=90"});
  EXPECT_EQ(config.steady_state.tolerance, apsis::usual_steady_tolerance);
  EXPECT_EQ(config.space.reconstruction, "upwind5");
  EXPECT_EQ(config.space.limiter, apsis::limiter_choice::none);
  const auto again = apsis::parse_case(to_toml(config), "written.toml");
  EXPECT_EQ(to_toml(again), to_toml(config));
  EXPECT_EQ(again.steady_state.iterations, 90);
  EXPECT_FALSE(
      apsis::parse_case(to_toml(apsis::load_case("gas/cavity")), "written.toml").steady_state.tolerance);
}

TEST(steady_run, needs_no_table_of_time) {
  const std::string text =
      "[model]\nname = \"bgk\"\nepsilon = \"0.02 + 0.2*x\"\n[initial]\nrho = 1\nu = 0\nT = 1\n[space]\ncells "
      "= 12\n"
      "formulation = \"finite-difference\"\n[boundary.left]\nkind = \"diffuse\"\nT = 1.2\n[boundary.right]\n"
      "kind = \"diffuse\"\n[velocity]\nmax = 7\npoints = 24\n[steady]\n";
  simulation run(apsis::parse_case(text, "gas.toml"));
  while (!run.finished()) run.advance();
  EXPECT_LE(run.step(), 60);
}

TEST(steady_run, solves_moment_equations_in_space_that_are_too_large_for_factors) {
  // The case has 1701 cells with 5 moments, more than the 8000 unknowns that are factorized.
  const std::string text = R"toml(
[parameters]
delta = 5
[model]
name = "bgk"
velocity_dimensions = 3
degrees_of_freedom = 3
collision_rate = "viscosity"
viscosity_exponent = 0.5
rarefaction = "delta"
[initial]
rho = 1
T = 1
[space]
cells = [12, 12, 12]
domain = [[0, 1], [0, 1], [0, 1]]
formulation = "finite-difference"
boundary = "diffuse"
[[space.solid]]
name = "box"
from = [0.25, 0.25, 0.25]
to = [0.5, 0.5, 0.5]
T = 1.2
[boundary.top]
velocity = [0.1, 0, 0]
[velocity]
set = "graded"
max = 4.5
points = 8
[steady]
tolerance = 1e-6
)toml";
  simulation run(apsis::parse_case(text, "cube.toml"));
  while (!run.finished()) run.advance();
  EXPECT_LE(run.step(), 60);
  // The fluxes are of mass, momentum and energy through each wall. Their sums over all walls vanish.
  const auto& flux = run.last().flux;
  ASSERT_EQ(flux.size(), 7u * 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    double sum = 0.0, largest = 0.0;
    for (std::size_t wall = 0; wall < 7; ++wall) {
      sum += flux[5 * wall + i];
      largest = std::max(largest, std::abs(flux[5 * wall + i]));
    }
    EXPECT_NEAR(sum, 0.0, 1e-6 * std::max(largest, 1e-3)) << i;
  }
}

TEST(steady_run, is_not_finished_where_the_iterations_are_over) {
  simulation run(apsis::load_case("gas/couette", {"space.cells=8", "steady.iterations=3"}));
  EXPECT_THROW(
      {
        while (!run.finished()) run.advance();
      },
      apsis::numerical_error);
  EXPECT_FALSE(run.finished());
  EXPECT_EQ(run.step(), 3);
}

TEST(steady_run, says_that_the_iterations_are_over_or_lead_nowhere) {
  bad_input::expect_refused({
      {[&] { end_of("gas/couette", {"steady.iterations=3"}); }, {"no steady state in 3 iterations"}, 3},
      // f jumps along rays from the ends of the lid. There the weights of WENO never settle.
      {[&] {
         end_of("gas/cavity", {"steady.iterations=1000", "space.cells=[16, 16]", "velocity.points=12",
                               "parameters.delta=1", "space.reconstruction=weno5-z"});
       },
       {"use upwind5"},
       3},
  });
}

TEST(steady_run, finds_a_shock_between_open_ends_and_before_a_step) {
  const simulation shock = found("gas/shock", {});
  for (const double net : shock.last().conservation_defect) EXPECT_LT(net, 1e-9);
  EXPECT_LE(shock.step(), 200);
  // The domain is too short for the thicker structure of this shock, so the fluxes at its ends differ.
  bad_input::expect_refused({
      {[&] { end_of("gas/shock", {"parameters.M=3", "steady.tolerance=1e-8"}); },
       {"a front has no position at which"},
       3},
  });
  const simulation step = found("gas/step", {"space.cells=[18,12]"});
  EXPECT_LE(step.step(), 120);
  const auto names = step.fields().names;
  const auto rho =
      step.fields()
          .values[static_cast<std::size_t>(std::find(names.begin(), names.end(), "rho") - names.begin())];
  // Behind a normal shock of Mach number 2 the density is 16/7 (Rankine, Hugoniot). At the wall it is higher.
  EXPECT_GT(*std::max_element(rho.begin(), rho.end()), 16.0 / 7.0);
}

TEST(steady_run, has_snapshots_after_whole_numbers_of_iterations) {
  const auto every = [](const std::string& value) {
    return apsis::load_case("gas/couette", {"steady.tolerance=1e-8", "output.every=" + value}).output.every;
  };
  EXPECT_EQ(every("5"), 5.0);
  EXPECT_EQ(every("0.1"), 0.0);  // a time
}

TEST(steady_run, marches_where_the_iteration_leaves_the_states_with_an_equilibrium) {
  const std::string burst =
      "[model]\nname = \"bgk\"\nepsilon = 0.1\n[initial]\nrho = \"x < 0.2 ? 1 : 1e-4\"\nT = 1\n[space]\n"
      "cells = 40\nformulation = \"finite-difference\"\nboundary = \"diffuse\"\n[boundary.right]\nT = 1.5\n"
      "[velocity]\nmax = 11\npoints = 50\n[steady]\ntolerance = 1e-8\n";
  testing::internal::CaptureStderr();
  simulation run(apsis::parse_case(burst, "burst.toml"));
  while (!run.finished()) run.advance();
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              testing::AllOf(HasSubstr("is not positive); steps in time from the first state until t = "),
                             testing::Not(HasSubstr("smaller step"))));
  EXPECT_LE(run.last().residual.front(), 1e-8);
  // The mass is that of the start, and the other net rates vanish.
  EXPECT_NEAR(run.last().total[0], run.initial_record().total[0], 1e-12);
  for (const double net : run.last().conservation_defect) EXPECT_LT(net, 1e-7);
  EXPECT_GT(run.last().min_value, 0.0);
}

TEST(steady_run, continues_from_rarer_gases_where_no_pseudo_time_term_helps) {
  testing::internal::CaptureStderr();
  const simulation run = found("gas/fourier", {"boundary.right.T=30", "velocity.max=22", "velocity.points=80",
                                               "parameters.delta=3000"});
  EXPECT_THAT(
      testing::internal::GetCapturedStderr(),
      HasSubstr("steady states with 1024, 256, 64, 16, 4 times the epsilon, one after the other, give"));
  // The gas keeps its mass. The heat that enters leaves again.
  EXPECT_NEAR(run.last().total[0], run.initial_record().total[0], 1e-12);
  const double left = run.last().flux[2], right = run.last().flux[5];
  EXPECT_GT(right, 0.01);
  EXPECT_NEAR(left, -right, 1e-6);
}

TEST(steady_run, warns_of_fluxes_that_are_not_linear) {
  const auto warnings_of = [](keys more) {
    more.emplace_back("steady.tolerance=1e-8");
    testing::internal::CaptureStderr();
    const simulation run(apsis::load_case("gas/couette", more));
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_THAT(warnings_of({}), testing::Not(HasSubstr("may never settle")));
  EXPECT_THAT(
      warnings_of({"space.reconstruction=weno5-z"}),
      HasSubstr("may never settle where f jumps along rays (the weights of weno5-z depend on f); write "
                "space.reconstruction = \"upwind5\" or \"weno5-z-smooth\""));
  EXPECT_THAT(warnings_of({"space.limiter=positivity"}), testing::Not(HasSubstr("may never settle")));
}

TEST(steady_run, settles_at_the_ends_of_a_lid_with_schemes_that_say_so) {
  // f jumps along rays from the ends of the lid.
  for (const apsis::reconstruction_entry* scheme : apsis::reconstruction_entries()) {
    if (!scheme->linear && !scheme->settles) continue;
    for (const char* U : {"0.15", "1.5"}) {
      const keys lid = {"space.cells=[16, 16]",
                        "velocity.points=12",
                        "parameters.delta=1",
                        "velocity.max=8",
                        std::string("parameters.U=") + U,
                        "space.reconstruction=" + scheme->name};
      EXPECT_LE(found("gas/cavity", lid).step(), 150) << scheme->name << " " << U;
    }
  }
}

namespace {

/// A flow whose steady state is negative somewhere without a limiter, and its keys.
struct strong_flow {
  const char* name;
  keys more;
};
void PrintTo(const strong_flow& of, std::ostream* out) {
  *out << of.name << " " << testing::PrintToString(of.more);
}

class strong_flows : public testing::TestWithParam<strong_flow> {};

std::vector<strong_flow> all_strong_flows() {
  std::vector<strong_flow> all;
  for (const char* delta : {"0.1", "10", "100"}) {
    const std::string rarefaction = std::string("parameters.delta=") + delta;
    // Walls with temperatures 9 and 1 for both models, and a lid with Mach number 1.2.
    const keys plates = {rarefaction, "boundary.left.T=9", "velocity.max=18", "velocity.points=48"};
    for (const std::string model : {"model.tails=nonnegative", "model.name=es-bgk"}) {
      if (delta == std::string("0.1") && model == "model.name=es-bgk") continue;  // nonnegative anyway
      keys more = plates;
      more.emplace_back(model);
      all.push_back({"gas/fourier", more});
    }
    all.push_back(
        {"gas/cavity",
         {rarefaction, "parameters.U=1.5", "space.cells=[12, 12]", "velocity.max=8", "velocity.points=12"}});
  }
  all.push_back({"gas/shock", {}});
  all.push_back({"gas/step", {"space.cells=[18, 12]"}});
  // Plates whose speeds differ by 6 and 10 speeds of sound, and walls with temperatures 100 and 1.
  for (const char* delta : {"1", "10"})
    for (const auto& [U, max, points] : {std::array{"3.9", "14", "[48, 48]"}, {"6.5", "19", "[48, 64]"}})
      all.push_back({"gas/couette",
                     {std::string("parameters.delta=") + delta, std::string("parameters.U=") + U,
                      std::string("velocity.max=") + max, std::string("velocity.points=") + points}});
  all.push_back({"gas/fourier",
                 {"parameters.delta=10", "model.name=es-bgk", "boundary.left.T=100", "boundary.right.T=1",
                  "velocity.max=40", "velocity.points=96"}});
  for (const char* knudsen : {"5", "0.5", "0.05"})
    all.push_back(
        {"gas/cylinder",
         {std::string("parameters.Kn=") + knudsen, "space.cells=[36, 18]", "velocity.points=[12, 12]"}});
  return all;
}

}  // namespace

TEST_P(strong_flows, are_nonnegative_with_the_limiter_and_have_the_tolerance) {
  const auto& [name, more] = GetParam();
  keys limited = more;
  limited.emplace_back("space.limiter=positivity");
  const simulation run = found(name, limited);
  EXPECT_EQ(run.last().negative_values, 0);
  EXPECT_GE(run.last().min_value, 0.0);
  EXPECT_LE(run.last().residual.front(), 1e-8);
  EXPECT_LE(run.step(), 160);
  EXPECT_LE(run.last().change, 1e-8);
  EXPECT_LT(found(name, more).last().min_value, 0.0);
}

TEST(steady_run, with_a_source_and_the_limiter_is_nonnegative) {
  const std::string jet =
      "[model]\nname = \"bgk\"\nepsilon = 0.3\n[initial]\nrho = 1\nT = 1\n[space]\ncells = 30\n"
      "formulation = \"finite-difference\"\n[boundary.left]\nkind = \"vacuum\"\n[boundary.right]\n"
      "kind = \"vacuum\"\n[velocity]\nmax = 9\npoints = 40\n[source]\nrho = \"x < 0.2 ? 1 : 0\"\n"
      "u = 1\nT = 0.5\n[steady]\ntolerance = 1e-8\n";
  const auto lowest = [&](const std::string& limiter) {
    simulation run(apsis::parse_case(jet, "jet.toml", {"space.limiter=" + limiter}));
    while (!run.finished()) run.advance();
    return run.last().min_value;
  };
  EXPECT_LT(lowest("none"), 0.0);
  EXPECT_GE(lowest("positivity"), 0.0);
}

INSTANTIATE_TEST_SUITE_P(gases, strong_flows, testing::ValuesIn(all_strong_flows()));

TEST(steady_run, settles_at_an_outflow_at_every_speed_and_rarefaction) {
  // The outflow copies the last row. In a rare gas only collisions change what enters there.
  const keys hypersonic = {"parameters.M=4", "parameters.Kn=2", "velocity.max=18", "velocity.points=28",
                           "space.cells=[18, 12]"};
  const keys coarse = {"space.cells=[30, 20]"};
  for (const keys& more :
       {keys{}, keys{"parameters.M=0.5"}, keys{"parameters.Kn=0.5"}, keys{"parameters.Kn=5"}, hypersonic}) {
    keys all = coarse;
    all.insert(all.end(), more.begin(), more.end());
    EXPECT_LE(found("gas/step", all).step(), 120) << testing::PrintToString(more);
  }
}

}  // namespace steady_runs_test
