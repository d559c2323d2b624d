// Order in time on a fixed mesh with ends of every kind. T(u) must be a smooth function of u and t.
#include <apsis/config/case.hpp>
#include <apsis/run/simulation.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace order_at_walls_test {

namespace {

/// A gas with ε = .2 + x and other temperature and velocity than its walls. It has no limiter, because one
/// for f ≥ 0 is not differentiable where it acts.
const std::string gas = R"toml(
[model]
name = "bgk"
velocity_dimensions = 2
degrees_of_freedom = 3
epsilon = "0.2 + x"
[initial]
rho = "1 + 0.1*sin(2*pi*x)"
T = 1
[space]
cells = 12
domain = [0, 1]
formulation = "finite-difference"
limiter = "none"
reconstruction = "upwind5"
boundary = "diffuse"
[velocity]
max = 6
points = 12
[time]
method = "md-imex-8-3-mixed"
end = 0.1
dt = 0.01
)toml";

using lines = std::vector<std::string>;

std::vector<double> result(const lines& overrides, int steps) {
  lines all = overrides;
  all.push_back(fmt::format("time.dt={:.17g}", 0.1 / steps));
  apsis::simulation run(apsis::parse_case(gas, "order.toml", all));
  while (!run.finished()) run.advance();
  EXPECT_EQ(run.step(), steps);
  return run.state();
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum);
}

/// Returns the slope of the differences between steps of Δt, Δt/2 and Δt/4.
double order_of(const lines& overrides, int steps) {
  const auto coarse = result(overrides, steps), middle = result(overrides, 2 * steps),
             fine = result(overrides, 4 * steps);
  return std::log2(distance(coarse, middle) / distance(middle, fine));
}

struct end {
  const char* name;
  lines values;
};

/// Ends on the left. The right end is a wall at rest unless it is given.
const std::vector<end> ends = {
    {"wall at rest", {}},
    {"moving wall", {"boundary.left.kind=diffuse", "boundary.left.velocity=[0, 0.5]"}},
    {"heated wall", {"boundary.left.kind=diffuse", "boundary.left.T=1.3"}},
    {"partly reflecting wall", {"boundary.left.kind=diffuse", "boundary.left.accommodation=0.6"}},
    {"oscillating walls",
     {"boundary.left.kind=diffuse", "boundary.left.velocity=[0, \"0.4*sin(20*t)\"]",
      "boundary.left.T=\"1 + 0.3*sin(15*t)\"", "boundary.right.kind=diffuse",
      "boundary.right.T=\"1.1 - 0.2*cos(12*t)\""}},
    {"inflow",
     {"boundary.left.kind=inflow", "boundary.left.rho=\"1 + 0.2*sin(15*t)\"", "boundary.left.u=[0.1, 0.2]",
      "boundary.left.T=1.1"}},
    {"given distribution",
     {"boundary.left.kind=given", "boundary.left.g=\"0.15*exp(-(v_x^2+v_y^2)/2)*(1+0.2*sin(15*t))\"",
      "boundary.left.h=\"0.15*exp(-(v_x^2+v_y^2)/2)\""}},
    // Gas enters in every step. If the flow turned, the state outside would jump from one gas to the other.
    {"far field",
     {"boundary.left.kind=far-field", "boundary.left.rho=1.1", "boundary.left.u=[0.3, 0]",
      "boundary.left.T=1"}},
    {"pressure", {"boundary.left.kind=pressure", "boundary.left.p=1.3"}},
    {"vacuum", {"boundary.left.kind=vacuum"}},
    {"symmetry", {"boundary.left.kind=symmetry"}},
    {"outflow", {"boundary.left.kind=outflow"}},
};

lines joined(lines a, const lines& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

// Differences of two step sizes have the slope p(1 + O(Δt)). At these steps it is within .1 of p for smooth
// problems. A kink of T(u) reduces the order by a half or more.
TEST(order_at_walls, is_three_and_four_at_ends_of_every_kind) {
  for (const end& left : ends) {
    EXPECT_NEAR(order_of(joined(left.values, {"time.method=md-imex-8-3-mixed"}), 20), 3.0, 0.15) << left.name;
    EXPECT_NEAR(order_of(joined(left.values, {"time.method=md-imex-16-4-efficient"}), 20), 4.0, 0.25)
        << left.name;
  }
}

TEST(order_at_walls, is_that_of_every_method) {
  struct claim {
    const char* method;
    double order;
  };
  const lines& walls = ends.at(4).values;
  for (const claim& one :
       {claim{"md-imex-3-2", 2.0}, {"md-imex-6-3", 3.0}, {"md-imex-6-2-mixed", 2.0}, {"ars-443", 3.0}})
    EXPECT_NEAR(order_of(joined(walls, {std::string("time.method=") + one.method}), 20), one.order, 0.2)
        << one.method;
}

TEST(order_at_walls, is_that_of_every_smooth_reconstruction_and_formulation) {
  for (const char* scheme : {"upwind1", "upwind5", "weno5-js"})
    for (const char* collisions : {"space.formulation=finite-difference", "space.formulation=finite-volume",
                                   "space.collisions=centres"}) {
      lines how = {std::string("space.reconstruction=") + scheme, collisions};
      if (std::string(collisions) == "space.collisions=centres")
        how.emplace_back("space.formulation=finite-volume");
      EXPECT_NEAR(order_of(joined(ends.at(4).values, how), 20), 3.0, 0.15) << scheme << " " << collisions;
    }
}

TEST(order_at_walls, is_three_beside_a_solid_box_in_the_plane) {
  const lines plane = {
      "space.cells=[12, 10]",        "space.domain=[[0, 1], [0, 1]]", "space.solid.1.from=[\"1/3\", 0.4]",
      "space.solid.1.to=[0.5, 0.6]", "space.solid.1.T=1.3",           "initial.u=[0.2, 0.1]",
      "velocity.points=10"};
  EXPECT_NEAR(order_of(plane, 10), 3.0, 0.2);
}

}  // namespace order_at_walls_test
