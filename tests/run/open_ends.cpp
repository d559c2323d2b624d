// Runs with open ends of a gas: sound that leaves or is reflected, balances, and the drag of a body between
// such ends.
#include <apsis/config/case.hpp>
#include <apsis/run/body_loads.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace open_ends_test {

namespace {

using apsis::simulation;

/// Returns a sound pulse of 1 % that runs to the right. It reaches the end at x = 1 at t = 0.5/√(5/3) = 0.39.
simulation pulse(const std::string& end, const std::string& epsilon) {
  return simulation(apsis::parse_case(R"toml(
[parameters]
A = 0.01
[model]
name = "bgk"
degrees_of_freedom = 3
[initial]
rho = "1 + A*exp(-100*(x - 0.5)^2)"
u = "A*sqrt(5/3)*exp(-100*(x - 0.5)^2)"
T = "(1 + A*exp(-100*(x - 0.5)^2))^(2/3)"
[space]
cells = 60
formulation = "finite-difference"
limiter = "positivity"
[velocity]
max = 7
points = 28
[time]
method = "md-imex-6-3"
safety = 1
end = 0.7
[boundary.left]
kind = "inflow"
rho = 1
T = 1
)toml" + end,
                                      "pulse.toml", {"model.epsilon=" + epsilon}));
}

/// Returns the largest change of the density after the pulse has reached the end, relative to the pulse.
double left_behind(simulation run) {
  while (!run.finished()) run.advance();
  EXPECT_LT(run.summary().conservation_defect, 1e-12);
  EXPECT_EQ(run.summary().negative_values, 0);
  double most = 0.0;
  const auto fields = run.fields();
  for (const double rho : fields.values.front()) most = std::max(most, std::abs(rho - 1.0) / 0.01);
  return most;
}

}  // namespace

TEST(open_ends, let_sound_leave_or_reflect_it) {
  const std::string far = "[boundary.right]\nkind = \"far-field\"\nrho = 1\nT = 1\n",
                    inflow = "[boundary.right]\nkind = \"inflow\"\nrho = 1\nT = 1\n",
                    pressure = "[boundary.right]\nkind = \"pressure\"\np = 1\n";
  // Measured: .001, .07 and .97. The far field avoids the reflection of plain inflow.
  EXPECT_LT(left_behind(pulse(far, "1e-6")), 0.01);
  EXPECT_GT(left_behind(pulse(inflow, "1e-6")), 0.03);
  EXPECT_GT(left_behind(pulse(pressure, "1e-6")), 0.8);
}

TEST(open_ends, given_by_the_maxwellian_of_inflow_is_inflow) {
  const std::string given =
      "[boundary.right]\nkind = \"given\"\ng = \"exp(-v_x^2/2)/sqrt(2*pi)\"\nh = "
      "\"2*exp(-v_x^2/2)/sqrt(2*pi)\"\n";
  const std::string inflow = "[boundary.right]\nkind = \"inflow\"\nrho = 1\nT = 1\n";
  simulation a = pulse(given, "0.1"), b = pulse(inflow, "0.1");
  while (!a.finished()) a.advance();
  while (!b.finished()) b.advance();
  double most = 0.0;
  const auto f = a.state(), g = b.state();
  for (std::size_t k = 0; k < f.size(); ++k) most = std::max(most, std::abs(f[k] - g[k]));
  // The Maxwellian of inflow is corrected to its moments. The correction is as large as the mass beyond the
  // grid, exp(-49/2) and less.
  EXPECT_LT(most, 1e-9);
}

TEST(open_ends, pressure_drives_a_flow_down_its_gradient) {
  // Quasi-one-dimensional flow without walls has no friction. It accelerates until its pressure is that of
  // both reservoirs minus the dynamic one. As much mass enters on one side as leaves on the other.
  simulation run(apsis::parse_case(R"toml(
[model]
name = "bgk"
degrees_of_freedom = 3
epsilon = 1e-2
[initial]
rho = 1
T = 1
[space]
cells = 20
limiter = "positivity"
formulation = "finite-difference"
[boundary.left]
kind = "pressure"
p = 1.1
[boundary.right]
kind = "pressure"
p = 0.9
[velocity]
max = 8
points = 32
[time]
method = "md-imex-6-3"
safety = 1
end = 3
)toml",
                                   "flow.toml"));
  while (!run.finished()) run.advance();
  const auto& flux = run.last().flux;
  EXPECT_GT(flux[0], 0.1);   // mass through the left face into the gas
  EXPECT_LT(flux[3], -0.1);  // mass through the right face
  EXPECT_LT(run.summary().conservation_defect, 1e-12);
}

TEST(open_ends, far_away_disturb_the_drag_of_a_body_less_than_inflow_and_outflow) {
  // A cylinder at Mach 2 and Kn = 1 in a half plane. The ends are at 2.5 radii, and at 3 and 4.
  const auto drag = [](bool far, bool near) {
    std::vector<std::string> overrides = {
        "parameters.Kn=1", "velocity.points=14", "velocity.max=6.5",    "time.method=md-imex-5-2",
        "time.end=5",      "output.every=0",     "space.cells=[24,16]", "space.domain=[[-3,3],[0,4]]"};
    if (near) overrides.insert(overrides.end(), {"space.cells=[20,10]", "space.domain=[[-2.5,2.5],[0,2.5]]"});
    for (const std::string side : {"left", "right", "top"})
      if (far) overrides.push_back("boundary." + side + ".kind=far-field");
    if (far)
      overrides.insert(overrides.end(), {"boundary.right.rho=1", "boundary.right.u=[\"M*sqrt(5/3)\",0]",
                                         "boundary.right.T=1"});
    simulation run(apsis::load_case("gas/cylinder", overrides));
    while (!run.finished()) run.advance();
    EXPECT_LT(run.summary().conservation_defect, 1e-13) << far << near;
    EXPECT_EQ(run.summary().negative_values, 0) << far << near;
    return apsis::body_loads(run.setup(), run.last()).front().force[0];
  };
  const double far = drag(true, false), given = drag(false, false);
  // The drags differ by 1.4e-3. The finite domain changes them more.
  EXPECT_NEAR(far, given, 3e-3 * given);
  // The nearer ends change the drags by 1.0 % and by 2.2 %.
  const double near_far = drag(true, true), near_given = drag(false, true);
  EXPECT_GT(near_given, 1.01 * given);
  EXPECT_LT(std::abs(near_far - far), 0.6 * std::abs(near_given - given));
}

}  // namespace open_ends_test
