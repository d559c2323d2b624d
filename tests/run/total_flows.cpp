// Runs with a given total mass flow through a side of the domain or a solid box.
#include "gas_tables.hpp"

#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
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
#include <support/bad_input.hpp>

namespace total_flows_test {
namespace {

using namespace apsis;

/// Returns a gas in a box. `space` has the keys of [space], `velocity` those of [velocity].
std::string gas_in(const std::string& space, const std::string& velocity = "max = 6\npoints = 12\n") {
  return gas_tables({.epsilon = "0.1", .velocity = velocity, .method = "md-imex-5-2", .end = "0.02"}) +
         "[initial]\nrho = 1\nT = 1\n[space]\n" + space;
}

/// Returns the mass per unit of time through a side or solid box in the last step.
double flow_through(const simulation& run, const std::string& side) {
  const auto names = run.setup().open_faces();
  const auto place = std::find(names.begin(), names.end(), side) - names.begin();
  return run.last().flux.at(static_cast<std::size_t>(place) * run.setup().equation->invariants().size());
}

/// Returns the table of a side with a total flow.
std::string with_flow(const std::string& side, const std::string& flow) {
  return fmt::format("[boundary.{}]\nkind = \"mass-flow\"\ntotal_flow = {}\n", side, flow);
}

void set_up(const std::string& text, const std::vector<std::string>& more = {}) {
  simulation run(parse_case(text, "total.toml", more));
}

const std::string disc = "[[space.body]]\nshape = \"circle\"\ncentre = [0, 0.55]\nradius = 0.25\nT = 1\n";

/// The flows are sums of some hundred terms of size 1 in each of 5 stages.
constexpr double rounding = 1e-13;

}  // namespace

TEST(total_flow, on_a_line_is_the_flux) {
  const std::string line = gas_in("cells = 12\nboundary = \"symmetry\"\n");
  const auto total = finished(line + with_flow("left", "0.2")),
             flux = finished(line + "[boundary.left]\nkind = \"mass-flow\"\nflux = 0.2\n");
  EXPECT_EQ(total.state(), flux.state());
  EXPECT_NEAR(flow_through(total, "left"), 0.2, rounding);
}

TEST(total_flow, in_the_plane_crosses_what_boxes_and_bodies_leave_open) {
  const std::string space = "cells = [10, 11]\ndomain = [[0, 1], [0, 1.1]]\nboundary = \"symmetry\"\n",
                    box = "[[space.solid]]\nname = \"lid\"\nfrom = [0, 0.8]\nto = [0.3, 1.1]\nT = 1\n";
  for (const std::string limiter : {"none", "positivity"})
    for (const std::string& obstacle : {std::string(), box, disc}) {
      const auto run =
          finished(gas_in(space) + with_flow("left", "0.15") + with_flow("right", "-0.11") + obstacle,
                   {"space.limiter=" + limiter});
      EXPECT_NEAR(flow_through(run, "left"), 0.15, rounding) << limiter << obstacle;
      EXPECT_NEAR(flow_through(run, "right"), -0.11, rounding) << limiter << obstacle;
      EXPECT_LT(run.summary().conservation_defect, 1e-12);
    }
}

TEST(total_flow, is_uniform_over_the_open_area) {
  // The disc covers 0.5 of 1.1, up to its polygon. Chords of the cut cells deviate by at most h²/8R = 0.005.
  const std::string space = "cells = [20, 22]\ndomain = [[0, 1], [0, 1.1]]\nboundary = \"symmetry\"\n" + disc;
  const auto total = finished(gas_in(space + with_flow("left", "0.12"))),
             flux = finished(gas_in(space + "[boundary.left]\nkind = \"mass-flow\"\nflux = 0.2\n"));
  EXPECT_NEAR(flow_through(total, "left") / flow_through(flux, "left"), 0.12 / (0.2 * 0.6), 0.02);
}

TEST(total_flow, of_a_solid_box_leaves_through_all_its_faces) {
  const std::string jet =
      "[[space.solid]]\nname = \"jet\"\nfrom = [0.4, 0]\nto = [0.6, 0.3]\nkind = \"mass-flow\"\n";
  const std::string space = "cells = [10, 8]\ndomain = [[0, 1], [0, 0.8]]\nboundary = \"outflow\"\n";
  const auto total = finished(gas_in(space) + jet + "total_flow = 0.24\n"),
             flux = finished(gas_in(space) + jet + "flux = 0.3\n");  // through 0.3 + 0.3 + 0.2
  EXPECT_NEAR(flow_through(total, "jet"), 0.24, rounding);
  EXPECT_NEAR(flow_through(flux, "jet"), 0.24, rounding);
}

TEST(total_flow, in_space_crosses_an_area) {
  const std::string space =
                        "cells = [6, 7, 14]\ndomain = [[0, 0.6], [0, 1], [0, 2]]\nboundary = \"symmetry\"\n",
                    ball = "[[space.body]]\nshape = \"sphere\"\ncentre = [0, 0.4, 1]\nradius = 0.35\nT = 1\n";
  for (const std::string& body : {std::string(), ball}) {
    const auto run = finished(
        gas_in(space, "max = 5\npoints = 8\n") + with_flow("left", "\"0.3 + t\"") + body, {"time.end=0.01"});
    // The flow is the mean over a step of a formula that is linear in t.
    EXPECT_NEAR(flow_through(run, "left"), 0.3 + run.last().t - 0.5 * run.last().dt, rounding) << body;
  }
}

TEST(total_flow, about_an_axis_crosses_rings) {
  const std::string velocity = "max = 5\npoints = 8\nrings = 6\nangles = 12\n",
                    sides = "geometry = \"axisymmetric\"\nboundary = \"diffuse\"\n";
  const std::string ball = "[[space.body]]\nshape = \"circle\"\ncentre = [0, 0]\nradius = 0.45\nT = 1\n";
  for (const std::string& body : {std::string(), ball}) {
    const auto run = finished(gas_in(sides + "cells = [10, 8]\ndomain = [[0, 1.5], [0, 1]]\n", velocity) +
                              with_flow("left", "0.5") + with_flow("top", "-0.7") + body);
    EXPECT_NEAR(flow_through(run, "left"), 0.5, rounding) << body;
    EXPECT_NEAR(flow_through(run, "top"), -0.7, rounding) << body;
  }
  // The flow is per length along the axis, through the circumference 2πr of both cylinders.
  const auto line =
      finished(gas_in(sides + "cells = 8\ndomain = [0.5, 1.5]\n", velocity) + with_flow("left", "0.4") +
               "[boundary.right]\nkind = \"mass-flow\"\nflux = -0.05\n");
  EXPECT_NEAR(flow_through(line, "left"), 0.4, rounding);
  EXPECT_NEAR(flow_through(line, "right"), -0.05 * 2.0 * std::numbers::pi * 1.5, rounding);
}

TEST(total_flow, that_is_steady_settles) {
  const auto run =
      finished(gas_in("cells = [6, 5]\ndomain = [[0, 1], [0, 0.5]]\nboundary = \"symmetry\"\n") +
                   with_flow("left", "0.05") + "[boundary.right]\nkind = \"pressure\"\np = 1\n[steady]\n",
               {});
  EXPECT_NEAR(flow_through(run, "left"), 0.05, 1e-8);
  EXPECT_NEAR(flow_through(run, "right"), -0.05, 1e-6);
}

TEST(total_flow, has_units_of_its_dimension) {
  const std::string gas =
      "[gas]\nname = \"argon\"\nlength = \"1 mm\"\ntemperature = \"300 K\"\npressure = \"100 Pa\"\n" +
      gas_tables({.epsilon = "", .velocity = "max = 6\npoints = 8\n", .method = "md-imex-5-2"}) +
      "[initial]\nrho = 1\nT = 1\n[space]\nboundary = \"symmetry\"\n";
  const auto flow_of = [&](const std::string& cells, const std::string& unit) {
    return gas + fmt::format("cells = {}\n", cells) + with_flow("left", "\"0.01 " + unit + "\"");
  };
  for (const auto& [cells, unit, length] :
       {std::tuple("8", "kg/(m^2 s)", 0), std::tuple("[6, 5]", "kg/(m s)", 1),
        std::tuple("[5, 5, 5]", "kg/s", 2)}) {
    const case_config config = parse_case(flow_of(cells, unit), "case.toml");
    dimension dims = dimensions::mass_flux;
    for (int k = 0; k < length; ++k) dims = dims * dimensions::length;
    EXPECT_NEAR(std::stod(config.faces[0].values.at("total_flow").front()) * config.scales->unit(dims), 0.01,
                1e-15)
        << unit;
  }
  bad_input::expect_refused({
      {[&] { set_up(flow_of("[5, 5, 5]", "kg/(m s)")); }, {"give it in kg/s"}},
      {[&] { set_up(flow_of("[6, 5]", "kg/s")); }, {"give it in kg/(m s)"}},
  });
}

TEST(total_flow, through_a_closed_side_is_refused) {
  const std::string wall = "[[space.solid]]\nfrom = [0, 0]\nto = [0.25, 1]\nT = 1\n";
  bad_input::expect_refused({
      {[&] { set_up(gas_in("cells = [8, 5]\nboundary = \"symmetry\"\n") + with_flow("left", "1") + wall); },
       {"'total_flow' is given at a side without an open face (bodies or solid boxes cover it)"}},
  });
}

}  // namespace total_flows_test
