// Runs on a device have the bits of the host.
#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/device/find_device.hpp>
#include <apsis/run/session.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <run/same_results.hpp>
#include <support/folder.hpp>
#include <support/tested_device.hpp>

namespace device_runs_test {

using namespace apsis;
using testing::HasSubstr;

namespace {

/// Returns a short run of a gas on a line, between walls or in a periodic domain.
std::string small_gas(bool between_walls, const std::string& time) {
  std::string text =
      "[model]\nname = \"bgk\"\nepsilon = \"0.001 + 0.1*x\"\n"
      "[space]\ncells = 20\ndomain = [0.0, 2.0]\nformulation = \"finite-difference\"\n"
      "[velocity]\nmax = 9.0\npoints = 36\n[output]\nevery = 0.011\n[time]\n" +
      time;
  if (between_walls)
    text +=
        "[boundary.left]\nkind = \"diffuse\"\nT = \"1 + 0.2*sin(20*t)\"\n[boundary.right]\nkind = "
        "\"diffuse\"\nT = 0.9\n";
  return text;
}

/// A short run of a gas with a solid box, between walls and open ends. The upper wall moves.
constexpr const char* flow_in_a_plane = R"case(
[model]
name = "bgk"
epsilon = "0.01 + 0.1*x"
collision_rate = "viscosity"
[initial]
rho = "1 + 0.2*cos(3*x + 2*y)"
u = [0.1, "0.2*x"]
T = "1.1 + 0.1*sin(5*x)"
[space]
cells = [6, 5]
domain = [[0, 0.75], [0, 0.625]]
formulation = "finite-difference"
boundary = "diffuse"
[[space.solid]]
name = "box"
from = [0.25, 0.25]
to = [0.5, 0.375]
[boundary.top]
velocity = [0.3, 0]
[boundary.left]
kind = "inflow"
rho = 1
u = [0.1, 0]
T = 1.1
[boundary.right]
kind = "outflow"
[velocity]
max = 9
points = [22, 20]
[output]
every = 0.004
[time]
method = "md-imex-8-3-mixed"
safety = 1
end = 0.004
)case";
/// The same flow in space. It has as many velocities as a quick test allows. Formulas give
/// all its equilibria.
constexpr const char* flow_in_space = R"case(
[model]
name = "bgk"
epsilon = "0.01 + 0.1*x"
[initial]
rho = "1 + 0.2*cos(3*x + 2*y)"
u = [0.1, "0.2*x", "0.1*y"]
T = "1.1 + 0.1*sin(5*z)"
[space]
cells = [6, 5, 5]
domain = [[0, 1.2], [0, 1], [0, 1]]
formulation = "finite-difference"
boundary = "diffuse"
[[space.solid]]
name = "box"
from = [0.4, 0.4, 0.2]
to = [0.8, 0.6, 0.6]
[boundary.top]
velocity = [0.3, 0, 0]
[boundary.left]
kind = "inflow"
rho = 1
u = [0.1, 0, 0]
T = 1.1
[boundary.right]
kind = "outflow"
[velocity]
max = 4.5
points = [6, 7, 9]
equilibrium = "formula"
[output]
every = 0.004
[time]
method = "md-imex-6-3"
safety = 1
end = 0.004
)case";

/// Returns the final state of a run and its history. It stops after `steps`, and continues a checkpoint if
/// there is one.
outcome run(const std::string& text, bool on_device, const std::string& folder = "", long steps = -1,
            std::optional<std::string> restart = {}) {
  session_options how;
  if (on_device) how.on = tested_device();
  if (!folder.empty()) how.out = folder;
  how.restart = std::move(restart);
  long done = 0;
  how.watch = [&done](const simulation& now) { done = now.step(); };
  how.stop = [&done, steps] { return steps >= 0 && done >= steps; };
  run_session session(parse_case(text, "gas.toml"), how);
  session.run();
  return {session.computed().state(), session.records().history(), session.records().fields()};
}

}  // namespace

TEST(device_runs, have_the_bits_of_the_host) {
  for (const std::string time : {"method = \"md-imex-8-3-mixed\"\nsafety = 1\nend = 0.03\n",
                                 "method = \"imex-bdf-3\"\ndt = 0.002\nend = 0.02\n",
                                 "method = \"imex-dimsim-3\"\ndt = 0.002\nend = 0.02\n",
                                 "method = \"md-imex-8-3-mixed\"\ntolerance = 1e-4\nsafety = 1\nend = 0.03\n",
                                 "method = \"md-imex-6-3\"\nsafety = 1\nend = 0.03\nsteady = 1e-9\n"})
    for (const bool between_walls : {false, true}) {
      const std::string text = small_gas(between_walls, time);
      expect_same(run(text, true), run(text, false), text);
    }
}

/// A step copies seven numbers of a cell for its checks and two for its change. It copies one more for each
/// solve that the host may have to repeat. The state has 100 numbers of a cell. With so many velocities no
/// solve is left to the host.
TEST(device_runs, a_step_does_not_copy_the_state_to_the_host) {
  constexpr int cells = 60, velocities = 100, steps = 5;
  std::string text = small_gas(false, "method = \"md-imex-6-3\"\nsafety = 1\nend = 0.1\nsteady = 1e-9\n");
  for (const auto& [from, to] : {std::pair{"every = 0.011", "every = 0"},
                                 {"cells = 20", "cells = 60"},
                                 {"max = 9.0", "max = 15.0"},
                                 {"points = 36", "points = 100"}})
    text.replace(text.find(from), std::string(from).size(), to);
  session_options how;
  how.on = tested_device();
  std::size_t first = 0, last = 0;
  long done = 0;
  how.watch = [&](const simulation& now) {
    done = now.step();
    (done == 1 ? first : last) = numbers_copied_to_host();
  };
  how.stop = [&] { return done > steps; };
  run_session(parse_case(text, "gas.toml"), how).run();
  EXPECT_LT(static_cast<double>(last - first), 0.25 * steps * cells * velocities);
}

/// Returns flows of molecules with internal degrees of freedom, for all models that have a kernel.
std::vector<std::string> flows_of_argon() {
  std::vector<std::string> all;
  for (const std::string model :
       {"bgk\"\ndegrees_of_freedom = 3", "shakhov\"", "shakhov\"\ntails = \"nonnegative\"", "es-bgk\""}) {
    std::string text = flow_in_a_plane;
    const std::string from = "bgk\"";
    text.replace(text.find(from), from.size(), model + "\nviscosity_exponent = 0.81");
    all.push_back(text);
  }
  return all;
}

TEST(device_runs, in_a_plane_and_in_space_have_the_bits_of_the_host) {
  std::vector<std::string> flows = flows_of_argon();
  flows.front() += "[force]\nacceleration = [\"0.2*cos(3*x + 40*t)\", 0.1]\n";
  flows.insert(flows.end(), {flow_in_a_plane, flow_in_space});
  for (const std::string& text : flows) expect_same(run(text, true), run(text, false), text);
}

TEST(device_runs, past_bodies_have_the_bits_of_the_host) {
  const std::string bodies = R"case([[space.body]]
name = "disc"
shape = "circle"
centre = [0.61, 0.52]
radius = 0.14
kind = "adiabatic"
accommodation = 0.6
velocity = ["0.52 - y", "x - 0.61"]
[[space.body]]
name = "floor"
shape = "half_space"
point = [0, 0.07]
normal = [0.1, 1]
kind = "symmetry"
)case";
  std::string text = flow_in_a_plane;
  text.insert(text.find("[boundary.top]"), bodies);
  text.replace(text.find("cells = [6, 5]"), 14, "cells = [12, 10]");
  text += "[force]\nacceleration = [0.2, 0.1]\n";
  text.replace(text.find("every = 0.004"), 13, "every = 0.004\nsurfaces = [\"disc\", \"floor\"]");
  const outcome host = run(text, false);
  expect_same(run(text, true), host, text);
  const test_folder folder;
  run(text, true, folder / "run", 1);
  expect_same(run(text, false, folder / "run", -1, folder / "run/checkpoint.h5"), host, text);
}

TEST(device_runs, with_sources_have_the_bits_of_the_host) {
  const std::string time = "method = \"md-imex-8-3-mixed\"\nsafety = 1\nend = 0.03\n";
  // One source is steady, and the other changes in time.
  for (const std::string rho : {"0.3", "\"x < 1 ? 0.3*(1 + sin(40*t)) : 0\""}) {
    const std::string source = "[source]\nrho = " + rho + "\nu = 0.1\nT = 1.2\n";
    for (const std::string& text :
         {small_gas(true, time) + source,
          small_gas(false, time) + source + "[force]\nacceleration = \"0.2*cos(3*x + 40*t)\"\n"})
      expect_same(run(text, true), run(text, false), text);
  }
}

TEST(device_runs, are_continued_on_the_host_and_on_a_device) {
  const std::string text = small_gas(true, "method = \"imex-bdf-3\"\ndt = 0.002\nend = 0.02\n");
  const outcome whole = run(text, false);
  for (const bool first : {false, true}) {
    const test_folder folder;
    run(text, first, folder / "run", 5);
    expect_same(run(text, !first, folder / "run", -1, folder / "run/checkpoint.h5"), whole,
                first ? "from a device to the host" : "from the host to a device");
  }
}

TEST(device_runs, are_refused_before_the_first_step_where_a_kernel_is_missing) {
  const std::string time = "method = \"md-imex-6-3\"\nsafety = 1\nend = 0.01\n";
  const auto refused = [](const std::string& text, const std::string& reason) {
    EXPECT_THAT([&] { run(text, true); }, testing::ThrowsMessage<input_error>(HasSubstr(reason))) << text;
  };
  const std::string gas = small_gas(false, time);
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = gas;
    return text.replace(text.find(from), from.size(), to);
  };
  refused(changed("formulation = \"finite-difference\"", "formulation = \"finite-volume\""), "formulation");
  refused(gas + "[steady]\ntolerance = 1e-6\n", "a table [steady]");
  refused(
      "[model]\nname = \"broadwell\"\nepsilon = 1\n[space]\ncells = 20\nformulation = "
      "\"finite-difference\"\n[time]\n" +
          time,
      "the kernel of its collisions is missing");
  refused("[model]\nname = \"decay\"\nepsilon = 1\n[time]\nmethod = \"md-imex-6-3\"\ndt = 0.1\nend = 1\n",
          "a model without space");
}

TEST(device_runs, unknown_devices_are_refused_with_those_that_there_are) {
  const bool none = found_devices().empty();
  EXPECT_THAT(
      [] { open_device("cuda:99"); },
      testing::ThrowsMessage<input_error>(HasSubstr(none ? "no device was found" : "no device 'cuda:99'")));
}

}  // namespace device_runs_test
