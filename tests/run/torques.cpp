// Torques on bodies in a gas at rest.
#include "gas_tables.hpp"

#include <apsis/run/body_loads.hpp>
#include <apsis/run/simulation.hpp>

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace torques_test {
namespace {

using namespace apsis;

const std::string gas = gas_tables({.degrees = "", .velocity = "max = 5\npoints = 10\n", .end = "0.05"}) +
                        "[output]\nsurfaces = \"all\"\n";

const std::string plane = gas + R"toml(
[initial]
rho = 1
u = [0, 0]
T = 1
[space]
cells = [24, 24]
domain = [[-2, 2], [-2, 2]]
boundary = "outflow"
)toml";

const std::string space = gas + R"toml(
[initial]
rho = 1
u = [0, 0, 0]
T = 1
[space]
cells = [9, 9, 9]
domain = [[-2, 2], [-2, 2], [-2, 2]]
boundary = "outflow"
)toml";

}  // namespace

/// Under a uniform pressure a closed surface has neither force nor torque, for any origin.
TEST(torques, of_a_gas_at_rest_vanish) {
  for (const std::string& text :
       {plane + "[[space.body]]\nshape = 'polygon'\npoints = [[-0.7, -0.5], [1.1, 0.1], [-0.1, 0.9]]\n",
        plane + "[[space.body]]\nshape = 'circle'\ncentre = [0.6, 0.3]\nradius = 0.9\n",
        space + "[[space.body]]\nshape = 'sphere'\ncentre = [0.3, -0.2, 0.1]\nradius = 1.1\n",
        space + "[[space.body]]\nshape = 'box'\nfrom = [-0.8, -0.7, -0.9]\nto = [0.9, 0.8, 1.1]\nrotate = "
                "[1, 2, -1, 25]\n"}) {
    const simulation run = finished(text);
    const body_load load = body_loads(run.setup(), run.last()).front();
    // The loads are sums of some hundred terms of the size of the pressure times the area of a cell.
    constexpr double rounding = 1e-13;
    for (const double force : load.force) EXPECT_NEAR(force, 0.0, rounding) << text;
    for (const double torque : load.torque) EXPECT_NEAR(torque, 0.0, rounding) << text;
  }
}

}  // namespace torques_test
