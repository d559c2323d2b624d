// Steady runs that fail from their first state, and flows without a steady state.
#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/run/simulation.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace steady_fallbacks_test {
namespace {

using apsis::simulation;
using testing::HasSubstr;

/// Returns a case in which gas enters on the left with a mass flux of 0.2.
std::string blown(const std::string& temperature, const std::string& outlet) {
  return "[model]\nname = \"bgk\"\ndegrees_of_freedom = 3\nepsilon = 0.05\n[initial]\nrho = 1\nT = 1\n"
         "[space]\ncells = 40\nformulation = \"finite-difference\"\n[boundary.left]\nkind = \"mass-flow\"\n"
         "flux = 0.2\nT = " +
         temperature + "\n[boundary.right]\nkind = " + outlet +
         "\n[velocity]\nmax = 9\npoints = 32\n[steady]\ntolerance = 1e-8\n";
}

simulation found(const std::string& text) {
  simulation run(apsis::parse_case(text, "blown.toml"));
  while (!run.finished()) run.advance();
  return run;
}

}  // namespace

TEST(steady_fallbacks, continue_where_an_iterate_is_too_hot_for_the_velocities_and_from_milder_ends) {
  testing::internal::CaptureStderr();
  simulation run(apsis::load_case(
      "gas/fourier",
      {"boundary.left.T=30", "boundary.right.T=1", "velocity.max=23", "velocity.points=40", "space.cells=20",
       "parameters.delta=1000", "model.name=es-bgk", "steady.tolerance=1e-8", "steady.iterations=1500"}));
  while (!run.finished()) run.advance();
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_THAT(log, HasSubstr("velocity.max is too small for the gas"));
  EXPECT_THAT(log, HasSubstr("steady states in which 0.015625 to 0.5 of what enters is that of the ends"));
  EXPECT_LE(run.last().residual.front(), 1e-8);
  EXPECT_NEAR(run.last().total[0], run.initial_record().total[0], 1e-12);
  const double left = run.last().flux[2], right = run.last().flux[5];
  EXPECT_GT(left, 0.01);
  EXPECT_NEAR(left, -right, 1e-6);
  // The velocities resolve the steady state.
  EXPECT_LT(run.summary().velocity_missed, 0.01);
}

TEST(steady_fallbacks, do_not_find_a_flow_whose_pressure_no_end_fixes) {
  // A far field at rest fixes u - 2a/(γ - 1), so u = 3 (a(T) - a(1)) and ρ = m/u. The momentum flux is ρT
  // + m u.
  for (const double T : {1.05, 1.21}) {
    const double u = 3.0 * (std::sqrt(5.0 / 3.0 * T) - std::sqrt(5.0 / 3.0));
    const simulation run = found(blown(fmt::format("{}", T), "\"far-field\"\nrho = 1\nT = 1"));
    EXPECT_NEAR(run.last().flux[1], 0.2 / u * T + 0.2 * u, 1e-5) << T;
  }
  // For a(T) = a(1) the density has no limit.
  try {
    static_cast<void>(found(blown("1", "\"far-field\"\nrho = 1\nT = 1")));
    FAIL();
  } catch (const apsis::numerical_error& failure) {
    EXPECT_THAT(failure.what(),
                HasSubstr("no end fixes the pressure); give the ends states with equal fluxes, "
                          "an outlet 'pressure'"));
  }
  const simulation run = found(blown("1", "\"pressure\"\np = 1"));
  EXPECT_NEAR(run.last().flux[1], 1.04, 1e-5);  // p + m²/ρ
}

}  // namespace steady_fallbacks_test
