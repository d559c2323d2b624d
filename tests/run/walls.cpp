// Runs between walls: balances, positivity, the free-molecular limit, accuracy up to the wall.
#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace walls_test {

namespace {

using apsis::simulation;

/// A monatomic gas between diffuse walls. The left wall is heated, and moves in two velocity dimensions.
const std::string gas_between_walls = R"toml(
title = "Gas between walls"
[parameters]
heat = 0.2
U = 0.3
[model]
name = "bgk"
velocity_dimensions = 1
degrees_of_freedom = 3
collision_rate = "viscosity"
viscosity_exponent = 0.81
epsilon = 0.1
[initial]
rho = 1
T = 1
[space]
cells = 16
formulation = "finite-difference"
limiter = "positivity"
[boundary.left]
kind = "diffuse"
T = "1 + heat*sin(4*t)"
[boundary.right]
kind = "diffuse"
[velocity]
max = 7
points = 20
[time]
method = "md-imex-6-3"
safety = 1
end = 0.2
)toml";

simulation run_of(const std::vector<std::string>& overrides) {
  return simulation(apsis::parse_case(gas_between_walls, "walls.toml", overrides));
}

void finish(simulation& run) {
  while (!run.finished()) run.advance();
}

/// Returns the amount received through the left or the right face. The order is [2][invariant].
double received(const simulation& run, int side, const std::string& invariant) {
  const auto names = run.setup().equation->invariants();
  const auto at = std::find(names.begin(), names.end(), invariant) - names.begin();
  return run.last().received[static_cast<std::size_t>(side) * names.size() + static_cast<std::size_t>(at)];
}

double flux(const simulation& run, int side, const std::string& invariant) {
  const auto names = run.setup().equation->invariants();
  const auto at = std::find(names.begin(), names.end(), invariant) - names.begin();
  return run.last().flux[static_cast<std::size_t>(side) * names.size() + static_cast<std::size_t>(at)];
}

}  // namespace

TEST(walls, balances_close_to_rounding_with_heat_and_motion) {
  // The promise checks every step. Here the sums over the run are checked.
  for (const char* formulation : {"finite-difference", "finite-volume"})
    for (const char* method : {"md-imex-6-3", "md-imex-3-2", "md-imex-8-3-mixed"}) {
      simulation run =
          run_of({std::string("space.formulation=") + formulation, std::string("time.method=") + method,
                  "model.velocity_dimensions=2", "boundary.left.velocity=[0, \"U*sin(9*t)\"]",
                  "boundary.right.accommodation=0.7"});
      EXPECT_TRUE(run.promises().conservation);
      finish(run);
      EXPECT_LT(run.summary().conservation_defect, 1e-13) << formulation << method;
      EXPECT_LT(std::abs(received(run, 0, "mass")), 1e-15);
      EXPECT_LT(std::abs(received(run, 1, "mass")), 1e-15);
      EXPECT_GT(received(run, 0, "energy"), 0.01);
      EXPECT_GT(std::abs(received(run, 0, "momentum_y")), 0.001);
      // Each side gives a momentum of about p t.
      EXPECT_NEAR(received(run, 0, "momentum_x"), 0.2, 0.05);
      EXPECT_NEAR(received(run, 1, "momentum_x"), -0.2, 0.05);
    }
}

TEST(walls, mass_does_not_drift) {
  simulation run = run_of({"time.end=1000", "space.cells=10", "velocity.points=12", "velocity.max=6.5"});
  for (int step = 0; step < 5000; ++step) run.advance();
  // The tolerance covers five thousand random rounding errors of one flux.
  EXPECT_LT(run.last().conservation_defect[0], 1e-14);
}

TEST(SLOW_walls, mass_is_conserved_over_1e5_steps) {
  simulation run = run_of({"time.end=1000", "space.cells=10", "velocity.points=12", "velocity.max=6.5"});
  for (int step = 0; step < 100'000; ++step) run.advance();
  EXPECT_LT(run.last().conservation_defect[0], 1e-12);
}

RC_GTEST_PROP(walls, keep_the_promises_of_every_method_kind_and_epsilon, ()) {
  const int cells = *rc::gen::inRange(5, 20);
  const std::string formulation = *rc::gen::element<std::string>("finite-difference", "finite-volume");
  std::vector<std::string> overrides = {
      "space.cells=" + std::to_string(cells),
      "model.epsilon=" + *rc::gen::element<std::string>("0", "1e-12", "1e-4", "0.1", "1e3", "1e12"),
      "space.formulation=" + formulation,
      "space.reconstruction=" + *rc::gen::element<std::string>("weno5-z", "weno5-js", "upwind1"),
      "time.method=" + *rc::gen::element<std::string>("md-imex-6-3", "md-imex-3-2", "md-imex-8-3-mixed"),
      "model.degrees_of_freedom=" + *rc::gen::element<std::string>("1", "3", "5"),
      "time.end=0.02"};
  if (formulation == "finite-volume" && cells >= 7 && *rc::gen::arbitrary<bool>())
    overrides.emplace_back("space.collisions=centres");
  const std::string kind = *rc::gen::element<std::string>("diffuse", "inflow", "symmetry", "outflow");
  overrides.push_back("boundary.right.kind=" + kind);
  if (kind == "inflow") {
    overrides.insert(overrides.end(),
                     {"boundary.right.rho=" + *rc::gen::element<std::string>("1e-9", "0.1", "5"),
                      "boundary.right.u=" + *rc::gen::element<std::string>("-1", "0.5"),
                      "boundary.right.T=\"0.8+0.1*sin(50*t)\""});
  } else if (kind == "diffuse") {
    overrides.push_back("boundary.right.accommodation=" + *rc::gen::element<std::string>("0", "0.3", "1"));
  }
  // The data have a jump and nearly a vacuum.
  overrides.insert(overrides.end(),
                   {"initial.rho=\"x < 0.4 ? 1 : " + *rc::gen::element<std::string>("1e-12", "0.1") + "\"",
                    "initial.u=" + *rc::gen::element<std::string>("0", "1", "-1")});
  simulation run = run_of(overrides);
  RC_ASSERT(run.promises().positivity);
  RC_ASSERT(run.promises().conservation);
  finish(run);  // throws where a promise is broken
  RC_ASSERT(run.summary().negative_values == 0);
}

RC_GTEST_PROP(walls, entropy_grows_by_no_more_than_the_walls_give, ()) {
  // S − Σ (E − u_w·m)/T_w decays, where m and E are the amounts that the walls gave (Darrozes & Guiraud). The
  // walls may have different temperatures.
  const auto text = [](double x) { return std::to_string(x); };
  const auto number = [](double from, double to) {
    return from + (to - from) * *rc::gen::inRange(0, 1001) / 1e3;
  };
  const std::string d = *rc::gen::element<std::string>("1", "2");
  std::vector<std::string> overrides = {
      "model.velocity_dimensions=" + d,
      "model.degrees_of_freedom=" + *rc::gen::element<std::string>("2", "3", "5"),
      "model.epsilon=" + *rc::gen::element<std::string>("0", "1e-6", "0.1", "1e12"),
      "space.reconstruction=upwind1",
      "space.cells=8",
      "time.method=" + *rc::gen::element<std::string>("md-imex-6-3", "md-imex-3-2", "md-imex-8-3-mixed"),
      "velocity.max=10",
      "velocity.points=32",
      "boundary.left.T=" + text(number(0.7, 1.4)),
      "boundary.right.T=" + text(number(0.7, 1.4)),
      "boundary.right.accommodation=" + text(number(0.0, 1.0)),
      "initial.rho=\"x < 0.4 ? 1 : 0.1\"",
      "initial.T=" + text(number(0.7, 1.4))};
  if (d == "2") overrides.push_back("boundary.right.velocity=[0, " + text(number(-1.0, 1.0)) + "]");
  simulation run = run_of(overrides);
  RC_ASSERT(run.promises().entropy);
  for (int step = 0; step < 30; ++step) run.advance();  // throws where a promise is broken
  RC_ASSERT(run.summary().max_entropy_increase <= 1e-14);
}

TEST(walls, give_entropy_by_cooling_a_gas) {
  // The bound is not that of a closed gas. S itself grows, but the corrected change is negative.
  simulation run = run_of({"space.reconstruction=upwind1", "boundary.left.T=0.7", "boundary.right.T=0.7"});
  ASSERT_TRUE(run.promises().entropy);
  const double before = run.initial_record().entropy;
  finish(run);
  EXPECT_GT(run.last().entropy, before + 0.01);
  EXPECT_LT(run.last().entropy_change, -1e-6);
  EXPECT_LE(run.summary().max_entropy_increase, 0.0);
}

TEST(walls, whose_entropy_is_not_bounded_promise_no_decay) {
  for (const std::vector<std::string>& open :
       {std::vector<std::string>{"boundary.left.T=\"1 + 0.1*sin(t)\""},
        {"boundary.right.kind=inflow", "boundary.right.rho=1", "boundary.right.T=1"},
        {"boundary.right.kind=outflow"},
        // On few velocities the discrete Maxwellian has other slopes than the formula.
        {"velocity.points=8"},
        {"force.acceleration=0.1"}}) {
    std::vector<std::string> overrides = {"space.reconstruction=upwind1"};
    overrides.insert(overrides.end(), {"boundary.left.T=1"});
    overrides.insert(overrides.end(), open.begin(), open.end());
    EXPECT_FALSE(run_of(overrides).promises().entropy) << open.front();
  }
  EXPECT_TRUE(run_of({"space.reconstruction=upwind1", "boundary.left.T=1"}).promises().entropy);
}

TEST(walls, beyond_the_step_limit_values_become_negative) {
  simulation run = run_of({"time.safety=1.5", "model.epsilon=1e12", "initial.rho=\"x < 0.4 ? 1 : 1e-9\""});
  EXPECT_FALSE(run.promises().positivity);
  finish(run);
  EXPECT_GT(run.summary().negative_values, 0);
}

TEST(walls, free_molecular_heat_and_shear_are_those_of_half_maxwellians) {
  // Without collisions each half of the velocities has the emission of its wall: f± = ρ± M[1, u±, T±] with
  // equal mass fluxes. The expected fluxes are discrete sums over the midpoints, where Maxwellians of density
  // 1 have spectral accuracy. Mass, shear stress and heat flux of the run must equal them after the slowest
  // molecules have crossed.
  const double hot = 1.2, U = 0.3;
  simulation run = run_of({"model.epsilon=1e12", "space.cells=8", "model.velocity_dimensions=2",
                           "velocity.points=16", "boundary.left.T=1.2", "boundary.left.velocity=[0, \"U\"]",
                           "time.end=40", "space.reconstruction=upwind1"});
  finish(run);
  const int n = 16;
  const double dv = 14.0 / n;
  double mass[2] = {0.0, 0.0}, shear = 0.0, energy[2] = {0.0, 0.0};
  for (int side = 0; side < 2; ++side) {
    const double T = side == 0 ? hot : 1.0, u = side == 0 ? U : 0.0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double v = -7.0 + (i + 0.5) * dv, w = -7.0 + (j + 0.5) * dv;
        if (side == 0 ? v < 0.0 : v > 0.0) continue;
        const double g =
            std::exp(-(v * v + (w - u) * (w - u)) / (2.0 * T)) / (2.0 * std::numbers::pi * T) * dv * dv;
        mass[side] += v * g;
        energy[side] += v * 0.5 * (v * v + w * w + T) * g;
      }
  }
  // In the steady state the total mass 1 is that of both halves.
  const double ratio = -mass[0] / mass[1];  // ρ₋/ρ₊
  const double plus = 2.0 / (1.0 + ratio), minus = ratio * plus;
  shear = plus * mass[0] * U;
  const double heat = plus * energy[0] + minus * energy[1];
  EXPECT_NEAR(flux(run, 0, "momentum_y"), shear, 1e-7 * shear);
  EXPECT_NEAR(flux(run, 1, "momentum_y"), -shear, 1e-7 * shear);
  EXPECT_NEAR(flux(run, 0, "energy"), heat, 1e-7 * heat);
  EXPECT_NEAR(flux(run, 1, "energy"), -heat, 1e-7 * heat);
}

TEST(walls, a_steady_state_ends_the_run) {
  const std::vector<std::string> heated = {"boundary.left.T=1.2", "time.end=500", "time.steady=1e-6",
                                           "space.reconstruction=upwind1", "velocity.points=12"};
  simulation run = run_of(heated);
  finish(run);
  EXPECT_LT(run.t(), 100.0);
  EXPECT_LE(run.last().change, 1e-6);
  // The heat that enters on one side leaves on the other. The difference heats the gas at the rate `change`.
  EXPECT_GT(flux(run, 0, "energy"), 0.01);
  EXPECT_NEAR(flux(run, 0, "energy"), -flux(run, 1, "energy"), 1e-5);

  auto short_of_it = heated;
  short_of_it[1] = "time.end=0.5";
  simulation cut = run_of(short_of_it);
  finish(cut);
  EXPECT_EQ(cut.t(), 0.5);
  EXPECT_GT(cut.last().change, 1e-6);

  // A continued run ends at the same step.
  simulation first = run_of(heated), second = run_of(heated);
  for (int step = 0; step < 100; ++step) first.advance();
  second.restore(first.save());
  finish(second);
  EXPECT_EQ(second.step(), run.step());
  EXPECT_EQ(second.state(), run.state());
}

TEST(walls, that_the_velocities_miss_are_reported_before_the_run) {
  const auto warning_of = [](const std::vector<std::string>& overrides) {
    testing::internal::CaptureStderr();
    run_of(overrides);
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_THAT(warning_of({"boundary.left.T=1.1"}), testing::Not(testing::HasSubstr("velocity.")));
  EXPECT_THAT(warning_of({"boundary.left.T=4"}),
              testing::HasSubstr("velocity.max = 7 is too small for the gas of [boundary.left] at t = 0 ("));
  EXPECT_THAT(
      warning_of({"boundary.right.T=\"1 + 20*t\""}),
      testing::AllOf(testing::HasSubstr("[boundary.right] at t = "), testing::HasSubstr("give at least")));
}

TEST(walls, values_of_formulas_that_no_wall_has_are_refused_with_their_place) {
  const auto refused = [](const std::vector<std::string>& overrides) {
    try {
      simulation run = run_of(overrides);
      finish(run);
    } catch (const apsis::input_error& failure) {
      return std::string(failure.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(
      refused({"boundary.right.accommodation=\"0.95 + 10*t\""}),
      testing::ContainsRegex("override '.*accommodation.*': the accommodation of \\[boundary\\.right\\] is "
                             "1\\.[0-9]+ at t = 0\\.[0-9]+ near \\(1\\) \\(a number from 0 to 1"));
  // The temperature jumps, so no value is too low for the velocities before.
  EXPECT_THAT(
      refused({"boundary.right.T=\"t < 0.02 ? 1 : -1\""}),
      testing::ContainsRegex("\\[boundary\\.right\\] has no Maxwellian at t = 0\\.[0-9]+ near \\(1\\) "
                             "\\(temperature -1 is not positive\\)"));
  // Before the temperature passes 0, no velocities are fine enough for it.
  EXPECT_THAT(refused({"boundary.right.T=\"1 - 12*t\""}),
              testing::ContainsRegex("\\[boundary\\.right\\] has no Maxwellian at t = 0\\.[0-9]+ "
                                     "\\(temperature -0\\.[0-9]+ is not positive\\); change its values"));
}

TEST(walls, a_remainder_of_rounding_before_the_end_makes_no_sliver) {
  const auto last_change = [](const std::string& end, long steps) {
    simulation run = run_of({"boundary.left.T=1.2", "time.steady=1e-12", "time.end=" + end});
    finish(run);
    EXPECT_EQ(run.summary().steps, steps);
    return run.last().change;
  };
  simulation step = run_of({"boundary.left.T=1.2", "time.end=1e9"});
  step.advance();
  const double dt = step.last().dt;
  const double whole = last_change(fmt::format("{:.17g}", 50.0 * dt), 50),
               one_more = last_change(fmt::format("{:.17g}", 50.0 * dt * (1.0 + 1e-13)), 51);
  EXPECT_GT(whole, 1e-6);
  // Steps shorter by 2 % change the rate by at most as much. In a step of 1e-13 rounding would give a change
  // of 3e-2.
  EXPECT_NEAR(one_more / whole, 1.0, 0.02);
}

TEST(walls, fields_of_a_steady_gas_are_the_fluxes_through_its_walls) {
  // The heat flux and the sum of stress and pressure are constant and equal those at the walls. Point values
  // and edge values of the second-order scheme at the wall differ by some 1e-3 of the heat flux.
  for (const char* model : {"bgk", "shakhov", "es-bgk"}) {
    auto config = apsis::parse_case(
        gas_between_walls, "walls.toml",
        {"boundary.left.T=1.2", "time.end=500", "time.steady=1e-6", std::string("model.name=") + model,
         "velocity.points=16", "output.fields=[\"p\", \"stress\", \"heat_flux\", \"distance\", \"mach\"]"});
    simulation run(config);
    finish(run);
    const auto fields = run.fields();
    const auto value = [&](const std::string& name, std::size_t cell) {
      const auto at = std::find(fields.names.begin(), fields.names.end(), name) - fields.names.begin();
      return fields.values.at(static_cast<std::size_t>(at))[cell];
    };
    const double heat = flux(run, 0, "energy"), force = flux(run, 0, "momentum");
    EXPECT_GT(heat, 0.01) << model;
    for (std::size_t cell = 0; cell < 16; ++cell) {
      EXPECT_NEAR(value("heat_flux", cell), heat, 5e-3 * heat) << model << cell;
      EXPECT_NEAR(value("p", cell) + value("stress", cell), force, 1e-4 * force) << model << cell;
      EXPECT_GT(value("distance", cell), 1e-3);
      EXPECT_LT(value("mach", cell), 1e-3);
    }
  }
}

}  // namespace walls_test
