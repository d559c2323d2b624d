// Loads of bodies: sums over pieces of wall, coefficients, history, restarts.
#include <apsis/run/body_loads.hpp>

#include "cases_in_space.hpp"
#include "streams_past_bodies.hpp"
#include "support/folder.hpp"

#include <apsis/core/text_file.hpp>
#include <apsis/run/manifest.hpp>
#include <apsis/run/result_units.hpp>
#include <apsis/run/setup.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace body_loads_test {
namespace {

using namespace streams_past_bodies;

position cross(const position& a, const position& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Returns ∫ (x − from) × n dA of a piece with these corners. The normal n points into the gas.
position moment_of_normal(const std::vector<position>& corners, const position& from) {
  std::vector<position> x = corners;
  for (position& one : x)
    for (std::size_t d = 0; d < 3; ++d) one[d] -= from[d];
  const auto middle_times = [](std::initializer_list<position> points, const position& area) {
    position middle{};
    for (const position& one : points)
      for (std::size_t d = 0; d < 3; ++d) middle[d] += one[d] / static_cast<double>(points.size());
    return cross(middle, area);
  };
  if (x.size() == 2) return middle_times({x[0], x[1]}, {x[1][1] - x[0][1], x[0][0] - x[1][0], 0.0});
  position sum{};
  for (std::size_t k = 1; k + 1 < x.size(); ++k) {
    position a = x[k], b = x[k + 1];
    for (std::size_t d = 0; d < 3; ++d) a[d] -= x[0][d], b[d] -= x[0][d];
    position area = cross(a, b);
    for (double& one : area) one *= 0.5;
    const position of_triangle = middle_times({x[0], x[k], x[k + 1]}, area);
    for (std::size_t d = 0; d < 3; ++d) sum[d] += of_triangle[d];
  }
  return sum;
}

/// Returns the torque Σ (x × F + p ∫ (x' − x) × n dA) of a table. F and p are the force and the pressure of
/// its rows.
position torque_of(const surface_table& table) {
  const columns wall = columns_of(table);
  const auto value = [&](const std::string& name, std::size_t k) {
    const auto column = wall.find(name);
    return column == wall.end() ? 0.0 : column->second[k];
  };
  position sum{};
  for (std::size_t k = 0; k < table.numbers.rows.size(); ++k) {
    const position x = {value("x", k), value("y", k), value("z", k)};
    const position given = {value("momentum_x", k), value("momentum_y", k), value("momentum_z", k)};
    const position n = {value("n_x", k), value("n_y", k), value("n_z", k)};
    const double pressing = given[0] * n[0] + given[1] * n[1] + given[2] * n[2];
    const position of_force = cross(x, given), of_pressure = moment_of_normal(table.corners[k], x);
    for (std::size_t d = 0; d < 3; ++d) sum[d] += value("area", k) * of_force[d] + pressing * of_pressure[d];
  }
  return sum;
}

}  // namespace

TEST(loads_of_bodies, are_sums_over_the_pieces_of_their_walls) {
  for (const std::string& text : {flat, deep}) {
    const simulation& run = run_of(text);
    const auto loads = body_loads(run.setup(), run.last());
    ASSERT_EQ(loads.size(), 2U);
    EXPECT_EQ(loads[0].name, "box");
    for (const body_load& body : loads) {
      const columns wall = columns_of(table_of(run, body.name));
      const auto force = [&](const char* axis) {
        return sum(wall,
                   [&](const columns& c, std::size_t k) { return c.at(std::string("momentum_") + axis)[k]; });
      };
      const position torque = torque_of(table_of(run, body.name));
      // The loads are sums of some fifty terms of the size of the pressure.
      constexpr double rounding = 1e-13;
      EXPECT_NEAR(body.force[0], force("x"), rounding);
      EXPECT_NEAR(body.force[1], force("y"), rounding);
      EXPECT_NEAR(body.heat, sum(wall, [](const columns& c, std::size_t k) { return c.at("energy")[k]; }),
                  rounding);
      EXPECT_GT(std::abs(body.force[0]), 1e-3);
      if (text == flat) {
        ASSERT_EQ(body.torque.size(), 1U);
        EXPECT_NEAR(body.torque[0], torque[2], rounding);
      } else {
        ASSERT_EQ(body.torque.size(), 3U);
        EXPECT_NEAR(body.force[2], force("z"), rounding);
        EXPECT_NEAR(body.torque[0], torque[0], rounding);
        EXPECT_NEAR(body.torque[1], torque[1], rounding);
        EXPECT_NEAR(body.torque[2], torque[2], rounding);
      }
    }
  }
}

TEST(loads_of_bodies, in_a_stream_have_the_coefficients_of_their_definition) {
  // U = (3, 4)/2, so |U| = 2.5 and ρU²/2 = 6.25.
  const reference_values plane{
      .density = 2, .temperature = 1, .length = 0.5, .velocity = {1.5, 2}, .centre = {1, -1}, .up = {}};
  const auto found = values_of({"a", {5, 10}, {7}, 25}, plane);
  EXPECT_NEAR(found.at("drag"), 11, 1e-14);        // (15 + 40)/5
  EXPECT_NEAR(found.at("lift"), 2, 1e-14);         // (−20 + 30)/5
  EXPECT_NEAR(found.at("moment"), 7 - 15, 1e-14);  // − (1·10 − (−1)·5)
  EXPECT_NEAR(found.at("C_D"), 11 / 3.125, 1e-14);
  EXPECT_NEAR(found.at("C_L"), 2 / 3.125, 1e-14);
  EXPECT_NEAR(found.at("C_M"), -8 / 1.5625, 1e-14);
  EXPECT_NEAR(found.at("C_H"), 25 / 7.8125, 1e-14);
  const reference_values space{.density = 2,
                               .temperature = 1,
                               .length = 3,
                               .area = 0.5,
                               .velocity = {0, 2, 0},
                               .centre = {0, 0, 2},
                               .up = {1, 5, 0}};
  const auto deep_ones = values_of({"a", {5, 10, -1}, {1, 2, 3}, 8}, space);
  EXPECT_EQ(deep_ones.at("C_D"), 10 / 2.0);
  EXPECT_EQ(deep_ones.at("C_L"), 5 / 2.0);
  // centre × F = (0·(−1) − 2·10, 2·5 − 0, 0).
  EXPECT_EQ(deep_ones.at("moment_x"), 21);
  EXPECT_EQ(deep_ones.at("moment_y"), -8);
  EXPECT_EQ(deep_ones.at("C_M_z"), 3 / 6.0);
  EXPECT_EQ(deep_ones.at("C_H"), 8 / 4.0);
}

TEST(loads_of_bodies, of_part_of_a_symmetric_body_are_those_that_do_not_vanish_for_the_whole) {
  using testing::ElementsAre;
  const auto names_of = [](const body_load& body, const reference_values& stream) {
    std::vector<std::string> names;
    for (const auto& [name, value] : values_of(body, stream)) names.push_back(name);
    return names;
  };
  const reference_values plane{
      .density = 2, .temperature = 1, .length = 0.5, .velocity = {1.5, 0}, .centre = {0, 0}, .up = {}};
  EXPECT_THAT(names_of({"a", {5, 10}, {7}, 25, {1}}, plane), ElementsAre("C_D", "C_H", "drag", "heat"));
  // Lift is the force along x. A mirror normal to z leaves the torque about z.
  const reference_values space{.density = 2,
                               .temperature = 1,
                               .length = 3,
                               .area = 0.5,
                               .velocity = {0, 2, 0},
                               .centre = {0, 0, 2},
                               .up = {1, 5, 0}};
  EXPECT_THAT(names_of({"a", {5, 10, -1}, {1, 2, 3}, 8, {0}}, space),
              ElementsAre("C_D", "C_H", "C_M_x", "drag", "heat", "moment_x"));
  EXPECT_THAT(names_of({"a", {5, 10, -1}, {1, 2, 3}, 8, {2}}, space),
              ElementsAre("C_D", "C_H", "C_L", "C_M_z", "drag", "heat", "lift", "moment_z"));
  EXPECT_THAT(names_of({"a", {5, 10, -1}, {1, 2, 3}, 8, {0, 2}}, space),
              ElementsAre("C_D", "C_H", "drag", "heat"));
}

TEST(loads_of_bodies, have_no_lift_at_a_plane_of_symmetry) {
  // Half of the disc lies above the plane of symmetry y = -2.
  const simulation run =
      finished(flat, {"space.body.1.centre=[-0.4, -2]", "space.body.1.velocity=[0, 0]", "time.end=0.02"});
  const auto loads = body_loads(run.setup(), run.last());
  ASSERT_EQ(loads.size(), 2U);
  for (const body_load& one : loads)
    EXPECT_EQ(one.mirrors, one.name == "disc" ? std::vector<int>{1} : std::vector<int>{}) << one.name;
  run_records records(run);
  records.add_step(run.last());
  const auto json = to_json(run, records)["bodies"];
  EXPECT_TRUE(json["disc"].contains("C_D"));
  EXPECT_FALSE(json["disc"].contains("C_L"));
  EXPECT_FALSE(json["disc"].contains("C_M"));
  EXPECT_TRUE(json["box"].contains("C_L"));
  const auto columns = result_history(records.history(), run).columns;
  EXPECT_THAT(columns, testing::IsSupersetOf({"C_D_disc", "C_H_disc", "torque_disc", "C_L_box", "C_M_box"}));
  EXPECT_THAT(columns, testing::Not(testing::Contains(testing::AnyOf("C_L_disc", "C_M_disc", "lift_disc"))));
}

TEST(loads_of_bodies, are_in_the_history_and_the_summary_in_units_of_the_results) {
  const simulation& run = run_of(flat);
  run_records records(run);
  records.add_step(run.last());
  const numeric_table table = result_history(records.history(), run);
  const auto last = [&](const std::string& name) {
    const auto& c = table.columns;
    return table.rows.back().at(static_cast<std::size_t>(std::find(c.begin(), c.end(), name) - c.begin()));
  };
  const auto json = to_json(run, records);
  for (const body_load& body : body_loads(run.setup(), run.last())) {
    const auto& listed = json["bodies"][body.name];
    EXPECT_EQ(listed["force"][1], body.force[1]);
    EXPECT_EQ(last("torque_" + body.name), body.torque[0]);
    for (const auto& [name, value] : values_of(body, *run.config().output.reference)) {
      EXPECT_EQ(last(name + "_" + body.name), value) << name;
      EXPECT_EQ(listed[name], value) << name;
    }
  }
  // Without a stream the history has force, torque and heat.
  const std::string text = flat.substr(0, flat.find("[output.reference]"));
  const simulation without = finished(text, {"time.end=0.05"});
  const auto short_json = to_json(without, run_records(without));
  EXPECT_EQ(short_json["bodies"]["disc"].size(), 3U);
  EXPECT_EQ(result_history(run_records(without).history(), without).columns.back(), "torque_disc");
  const auto in_space = finished(deep, {"time.end=0"});
  EXPECT_THAT(result_history(run_records(in_space).history(), in_space).columns,
              testing::IsSupersetOf({"torque_ball_x", "moment_ball_z", "C_M_ball_y", "C_L_box"}));
}

TEST(loads_of_bodies, are_those_of_a_turned_flow) {
  // The map x → y, y → −x turns vectors and leaves numbers unchanged.
  const std::string turned = gas_tables({}) + R"toml(
[initial]
rho = 1
u = [0, 1.2]
T = 1
[space]
cells = [12, 16]
domain = [[-1.5, 1.5], [-2, 2]]
boundary = "outflow"
[[space.body]]
name = "wing"
shape = "ellipse"
centre = [0.1, -0.2]
semi_axes = [0.6, 1]
angle = 20
[output.reference]
density = 1
velocity = [0, 1.2]
temperature = 1
length = 2
)toml";
  std::string lying = turned;
  const auto change = [&lying](const std::string& from, const std::string& to) {
    for (auto at = lying.find(from); at != std::string::npos; at = lying.find(from, at + to.size()))
      lying.replace(at, from.size(), to);
  };
  change("[0, 1.2]", "[1.2, 0]");
  change("[12, 16]", "[16, 12]");
  change("[[-1.5, 1.5], [-2, 2]]", "[[-2, 2], [-1.5, 1.5]]");
  change("[0.1, -0.2]", "[-0.2, -0.1]");
  change("[0.6, 1]", "[1, 0.6]");
  const simulation up = finished(turned), right = finished(lying);
  const auto a = values_of(body_loads(up.setup(), up.last()).front(), *up.config().output.reference),
             b = values_of(body_loads(right.setup(), right.last()).front(), *right.config().output.reference);
  for (const auto& [name, value] : a) EXPECT_NEAR(value, b.at(name), 1e-11) << name;
  EXPECT_GT(std::abs(a.at("C_L")), 0.05);
  EXPECT_GT(std::abs(a.at("C_M")), 0.005);
}

TEST(loads_of_bodies, of_a_continued_run_are_those_of_an_uninterrupted_one) {
  const test_folder folder;
  in_several_dimensions::run_into(folder / "whole", flat);
  in_several_dimensions::run_into(folder / "first", flat, {"time.end=0.05"});
  session_options how;
  how.out = folder / "second";
  how.restart = folder / "first/checkpoint.h5";
  run_session(parse_case(flat, "case.toml"), how).run();
  for (const std::string file :
       {"history.csv", "surfaces/disc.csv", "surfaces/disc.vtp", "surfaces/box.vtp"}) {
    const auto text = [&](const std::string& of) {
      return read_text_file(folder / (of + "/" + file), 10'000'000, "file");
    };
    EXPECT_EQ(text("whole"), text("second")) << file;
  }
}

}  // namespace body_loads_test
