// One rule covers the range and the spacing of velocities. Before a run it applies to data, walls, ends and
// sources. During a run it applies to every cell.
#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/run/manifest.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace velocity_range_test {

namespace {

using apsis::simulation;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using overrides = std::vector<std::string>;

/// Two jets that meet. The energy of their motion becomes T = 9.
const std::string jets = R"toml(
title = "Jets"
[model]
name = "bgk"
epsilon = 0.1
[initial]
rho = 1
u = 3
T = 0.1
[[initial.region]]
where = "x > 0.5"
u = -3
[space]
cells = 24
boundary = "outflow"
limiter = "positivity"
[velocity]
max = 4.8
points = 48
[time]
method = "md-imex-6-3"
safety = 1
end = 0.1
)toml";

/// A gas at rest between walls.
const std::string gas = R"toml(
title = "Gas"
[model]
name = "bgk"
degrees_of_freedom = 3
epsilon = 0.1
[initial]
rho = 1
T = 1
[space]
cells = 8
formulation = "finite-difference"
boundary = "diffuse"
[velocity]
max = 7
points = 28
[time]
method = "md-imex-3-2"
dt = 0.005
end = 0.01
)toml";

/// The messages of a run and its outcome.
struct outcome {
  std::string warnings, error;
  int code = 0;
  apsis::run_summary summary = {};
};

outcome run_of(const std::string& text, const overrides& changes = {}) {
  outcome found;
  testing::internal::CaptureStderr();
  try {
    simulation run(apsis::parse_case(text, "gas.toml", changes));
    try {
      while (!run.finished()) run.advance();
    } catch (const apsis::numerical_error& failure) {
      found.error = failure.what();
      found.code = static_cast<int>(failure.code());
    }
    found.summary = run.summary();
  } catch (const apsis::input_error& failure) {
    found.error = failure.what();
    found.code = static_cast<int>(failure.code());
  }
  found.warnings = testing::internal::GetCapturedStderr();
  return found;
}

long times_in(const std::string& text, const std::string& word) {
  long count = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

/// Returns the number after a word of a message.
double number_after(const std::string& text, const std::string& word) {
  const auto at = text.find(word);
  EXPECT_NE(at, std::string::npos) << text;
  return at == std::string::npos ? 0.0 : std::stod(text.substr(at + word.size()));
}

/// Returns the share of the mass, or of the energy, of a Maxwellian at rest beyond ±κ √T.
double mass_beyond(double kappa) {
  return std::erfc(kappa / std::sqrt(2.0));
}
double energy_beyond(double kappa) {
  return mass_beyond(kappa) + 2.0 * kappa * std::exp(-0.5 * kappa * kappa) / std::sqrt(2.0 * M_PI);
}

std::string write_velocities(const std::string& name, double max, int points) {
  std::string path = testing::TempDir() + name;
  std::ofstream out(path);
  const double spacing = 2.0 * max / points;
  for (int j = 0; j < points; ++j)
    out << fmt::format("{:.17g},{:.17g}\n", spacing * (j + 0.5) - max, spacing);
  return path;
}

}  // namespace

TEST(velocity_range, a_gas_that_grows_beyond_the_grid_ends_the_run_with_the_value_that_would_do) {
  for (const char* model : {"bgk", "es-bgk", "shakhov"}) {
    const outcome narrow = run_of(jets, {fmt::format("model.name={}", model)});
    EXPECT_EQ(narrow.code, 3) << model;
    EXPECT_THAT(narrow.error, AllOf(HasSubstr("velocity.max = 4.8 is too small for the gas ("),
                                    HasSubstr("give at least "), HasSubstr("cell "), HasSubstr("step ")))
        << model;
    EXPECT_LE(times_in(narrow.warnings, "velocity.max = 4.8 is too small"), 1) << narrow.warnings;
    // The suggested value suffices, although T is far from its maximum when the run ends.
    const double max = number_after(narrow.error, "give at least "),
                 points = number_after(narrow.error, "velocity.points = ");
    const outcome wide =
        run_of(jets, {fmt::format("model.name={}", model), fmt::format("velocity.max={}", max),
                      fmt::format("velocity.points={}", points)});
    EXPECT_EQ(wide.code, 0) << wide.error;
    EXPECT_THAT(wide.warnings, Not(HasSubstr("velocity.max"))) << model;
    EXPECT_LT(wide.summary.velocity_missed, 1e-3) << model;
    EXPECT_LT(max, 30.0) << model;  // and is not much larger than necessary
  }
}

TEST(velocity_range, in_the_middle_a_run_warns_once_and_reports_what_it_missed) {
  const outcome middle = run_of(jets, {"velocity.max=11", "velocity.points=110"});
  EXPECT_EQ(middle.code, 0) << middle.error;
  EXPECT_EQ(times_in(middle.warnings, "velocity.max = 11 is too small for the gas in cell "), 1)
      << middle.warnings;
  EXPECT_GT(middle.summary.velocity_missed, 1e-3);
  EXPECT_LT(middle.summary.velocity_missed, 0.1);
  // The gas is nearly at rest, so the shares are those of the normal distribution.
  const double kappa = middle.summary.velocity_room;
  EXPECT_NEAR(middle.summary.velocity_beyond / mass_beyond(kappa), 1.0, 0.5);
  EXPECT_NEAR(middle.summary.velocity_missed / energy_beyond(kappa), 1.0, 0.5);
  EXPECT_GT(middle.summary.velocity_needed, 11.0);
}

TEST(velocity_range, several_directions_and_other_sets_are_watched) {
  const outcome plane = run_of(jets, {"model.velocity_dimensions=2", "velocity.points=[48,24]"});
  EXPECT_EQ(plane.code, 3) << plane.error;
  EXPECT_THAT(plane.error, HasSubstr("velocity.max = 4.8 is too small for the gas"));
  const outcome graded = run_of(jets, {"velocity.set=graded", "velocity.points=96", "velocity.max=4.8"});
  EXPECT_EQ(graded.code, 3) << graded.error;
  EXPECT_THAT(graded.error, HasSubstr("velocity.max is too small for the gas (the 96 velocities"));
  const std::string file = write_velocities("narrow.csv", 4.8, 48);
  std::string by_file = jets;
  by_file.replace(by_file.find("max = 4.8\npoints = 48"), 21, "set = \"" + file + "\"");
  const outcome given = run_of(by_file);
  EXPECT_EQ(given.code, 3) << given.error;
  EXPECT_THAT(given.error, HasSubstr("the velocities end too early for the gas"));
}

TEST(velocity_range, without_collisions_the_maxwellian_does_not_matter) {
  const outcome free = run_of(jets, {"model.epsilon=1e3"});
  EXPECT_EQ(free.code, 0) << free.error;
  EXPECT_THAT(free.warnings, IsEmpty());
  EXPECT_GT(free.summary.velocity_room, 4.0);
}

TEST(velocity_range, cells_with_little_mass_do_not_end_a_run) {
  // Molecules that move ahead of a gas into empty space have velocities near the end of the grid.
  const outcome empty = run_of(gas, {"space.boundary=outflow", "initial.rho=\"x < 0.5 ? 1 : 1e-30\"",
                                     "time.end=0.06", "space.cells=16"});
  EXPECT_EQ(empty.code, 0) << empty.error;
}

TEST(velocity_range, is_the_same_for_uniform_sets_and_files_of_their_velocities) {
  for (const double max : {2.0, 2.4, 2.6, 3.0, 3.9, 4.2, 5.0, 6.0}) {
    const std::string size = fmt::format("max = {}\npoints = 32", max),
                      file = "set = \"" + write_velocities("same.csv", max, 32) + "\"";
    std::string uniform = gas, by_file = gas;
    uniform.replace(uniform.find("max = 7\npoints = 28"), 19, size);
    by_file.replace(by_file.find("max = 7\npoints = 28"), 19, file);
    const outcome one = run_of(uniform, {"space.boundary=periodic"}),
                  other = run_of(by_file, {"space.boundary=periodic"});
    EXPECT_EQ(one.code, other.code) << max;
    EXPECT_EQ(one.warnings.empty(), other.warnings.empty()) << max << one.warnings << other.warnings;
    // The rule has these bands for a gas at rest with T = 1.
    const double missed = energy_beyond(max);
    EXPECT_EQ(one.code, missed > 0.1 ? 2 : 0) << max << one.error;
    EXPECT_EQ(one.warnings.empty(), missed > 0.1 || missed < 1e-3) << max << one.warnings;
  }
}

TEST(velocity_range, of_published_decks_is_accepted) {
  // Velocities up to ±5 and ±6 thermal speeds of the reference state suffice for gas and walls
  // that are hotter.
  EXPECT_EQ(run_of(gas, {"velocity.max=5", "boundary.left.T=1.3"}).code, 0);
  EXPECT_THAT(run_of(gas, {"velocity.max=5", "boundary.left.T=1.3"}).warnings, IsEmpty());
  EXPECT_EQ(run_of(gas, {"velocity.max=6", "initial.T=2"}).code, 0);
  const outcome hot = run_of(gas, {"velocity.max=5", "boundary.left.T=2"});
  EXPECT_EQ(hot.code, 0) << hot.error;
  EXPECT_EQ(times_in(hot.warnings, "velocity.max = 5 is too small for the gas of [boundary.left]"), 1)
      << hot.warnings;
}

TEST(velocity_range, messages_of_a_gas_with_units_have_them) {
  const std::string argon = R"toml(
title = "Argon"
[gas]
name = "argon"
pressure = "10 Pa"
temperature = "300 K"
length = "1 mm"
[model]
name = "bgk"
[initial]
rho = 1
T = "1200 K"
[space]
cells = 8
formulation = "finite-difference"
[velocity]
max = "1250 m/s"
points = 40
[time]
method = "md-imex-3-2"
dt = "10 ns"
end = "20 ns"
)toml";
  const outcome found = run_of(argon);
  EXPECT_EQ(found.code, 0) << found.error;
  // √(RT) = 499.7 m/s at 1200 K, and the range is six times as large.
  EXPECT_THAT(found.warnings,
              AllOf(HasSubstr("[1250 m/s] is too small"), HasSubstr("[1200 K]"), HasSubstr("[2999 m/s]")));
  // Without the unit the gas is far too hot. The warning precedes the error.
  std::string forgotten = argon;
  const std::string unit = "\"1200 K\"";
  forgotten.replace(forgotten.find(unit), unit.size(), "1200");
  const outcome refused = run_of(forgotten);
  EXPECT_EQ(refused.code, 2) << refused.error;
  EXPECT_THAT(refused.warnings,
              AllOf(HasSubstr("'initial.T' = 1200 is 360000 K"), HasSubstr("write \"1200 K\" if")));
}

TEST(velocity_range, a_force_that_presses_the_gas_against_the_end_is_seen) {
  const overrides fall = {"space.boundary=periodic", "model.epsilon=0.1", "time.end=2", "velocity.points=56"};
  overrides strong = fall;
  strong.insert(strong.end(), {"force.acceleration=4", "time.dt=0.02"});
  const outcome ended = run_of(gas, strong);
  EXPECT_EQ(ended.code, 3) << ended.error;
  EXPECT_THAT(ended.error, HasSubstr("velocity.max = 7 is too small for the gas"));
  // The suggested value includes the velocity at the end, 4 · 2, and six thermal speeds.
  EXPECT_GE(number_after(ended.error, "give at least "), 14.0);
  EXPECT_LT(number_after(ended.error, "give at least "), 15.0);
}

TEST(velocity_range, the_mass_that_a_force_moves_into_the_last_velocities_is_what_they_gain) {
  // Without collisions only the force changes the mass. For f = M(v − at), ½ erfc((w − at)/√2) is beyond the
  // lower edge w = V − Δv of the last cell. The reconstruction uses the molecules that accumulate there, and
  // moves more.
  const overrides fall = {
      "space.boundary=periodic", "model.epsilon=1e12", "force.acceleration=1", "time.end=2", "time.dt=0.01",
      "velocity.max=4",          "velocity.points=80"};
  testing::internal::CaptureStderr();
  simulation run(apsis::parse_case(gas, "gas.toml", fall));
  const double spacing = 0.1, before = run.row(0)[79], edge = 3.9;
  while (!run.finished()) run.advance();
  const std::string warnings = testing::internal::GetCapturedStderr();
  const double held = run.summary().velocity_held, moved = 0.5 * std::erfc((edge - 2.0) / std::sqrt(2.0));
  EXPECT_NEAR(held, spacing * (run.row(0)[79] - before), 1e-10);
  EXPECT_GT(held, moved);
  EXPECT_LT(held, 1.5 * moved);
  EXPECT_EQ(times_in(warnings, "the force moves the gas into the ends of the velocity grid"), 1) << warnings;
  // The lost share of the energy grows above one percent.
  EXPECT_GT(run.summary().force_lost_energy, 0.01);
  EXPECT_EQ(times_in(warnings, "the force gives the gas less energy than it should"), 1) << warnings;
  const outcome none = run_of(gas, {"space.boundary=periodic", "force.acceleration=0.1"});
  EXPECT_LT(none.summary.velocity_held, 1e-10);
}

TEST(velocity_range, advice_for_a_beam_at_the_end_is_beyond_the_present_velocities) {
  // The moments of the gas do not reveal the beam: a Maxwellian with them ends at 7.2.
  std::string text = gas;
  text.replace(text.find("rho = 1\nT = 1\n"), 14,
               "g = \"0.98*exp(-v_x^2/2)/sqrt(2*pi) + (abs(v_x - 7.5) < 0.5 ? 0.02 : 0)\"\n"
               "h = \"2*0.98*exp(-v_x^2/2)/sqrt(2*pi)\"\n");
  const outcome found = run_of(text, {"model.epsilon=1e12", "velocity.max=8", "velocity.points=64",
                                      "force.acceleration=3", "time.end=0.1"});
  EXPECT_EQ(found.code, 0) << found.error;
  EXPECT_THAT(found.warnings, HasSubstr("the force gives the gas less energy than it should"));
  EXPECT_THAT(found.warnings, HasSubstr("give a velocity.max above 8, or more velocity.points"));
}

TEST(velocity_range, totals_survive_a_restart) {
  const auto text = apsis::parse_case(jets, "jets.toml", {"velocity.max=11", "velocity.points=110"});
  testing::internal::CaptureStderr();
  simulation whole(text), first(text), second(text);
  while (!whole.finished()) whole.advance();
  for (int step = 0; step < 100; ++step) first.advance();
  second.restore(first.save());
  while (!second.finished()) second.advance();
  testing::internal::GetCapturedStderr();
  const auto a = whole.summary(), b = second.summary();
  EXPECT_EQ(a.velocity_room, b.velocity_room);
  EXPECT_EQ(a.velocity_resolution, b.velocity_resolution);
  EXPECT_EQ(a.velocity_beyond, b.velocity_beyond);
  EXPECT_EQ(a.velocity_missed, b.velocity_missed);
  EXPECT_EQ(a.velocity_needed, b.velocity_needed);
  EXPECT_EQ(apsis::manifest(whole, {})["result"]["velocity_beyond"], a.velocity_beyond);
}

TEST(velocity_range, other_models_have_none) {
  const simulation run(apsis::load_case("paper/broadwell", {"time.end=0.01"}));
  EXPECT_TRUE(std::isinf(run.summary().velocity_room));
  EXPECT_TRUE(apsis::manifest(run, {})["result"]["velocity_room"].is_null() ||
              std::isinf(apsis::manifest(run, {})["result"]["velocity_room"].get<double>()));
}

}  // namespace velocity_range_test
