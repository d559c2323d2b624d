// Tables of the walls of bodies: one-way fluxes, coefficients of pieces, and the order of pieces
// along the wall.
#include "streams_past_bodies.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace body_tables_test {

using namespace streams_past_bodies;

TEST(one_way_fluxes, of_mass_are_equal_at_every_wall_and_their_difference_is_what_is_given) {
  for (const std::string& text : {flat, deep}) {
    const simulation& run = run_of(text);
    for (const surface_table& table : run.surfaces()) {
      const columns wall = columns_of(table);
      const bool is_wall = table.name == "disc" || table.name == "ball" || table.name == "box" ||
                           (text == flat && (table.name == "top" || table.name == "bottom"));
      for (std::size_t k = 0; k < wall.at("area").size(); ++k) {
        const double arriving = wall.at("mass_arriving")[k], leaving = wall.at("mass_leaving")[k];
        EXPECT_GE(arriving, 0.0);
        EXPECT_GE(leaving, 0.0);
        EXPECT_GE(wall.at("energy_arriving")[k], 0.0);
        EXPECT_GE(wall.at("energy_leaving")[k], 0.0);
        if (!is_wall) continue;
        EXPECT_GT(arriving, 0.05);
        // The fluxes are sums over some hundred velocities.
        EXPECT_NEAR(arriving, leaving, 1e-13) << table.name;
        if (table.name != "bottom") continue;
        EXPECT_NEAR(wall.at("energy_arriving")[k], wall.at("energy_leaving")[k], 1e-13);
      }
    }
  }
}

TEST(coefficients_of_pieces, are_the_columns_over_the_pressure_of_the_stream) {
  const simulation& run = run_of(flat);
  const columns wall = columns_of(table_of(run, "disc"));
  const double q = 0.5 * 1.1 * 1.6, speed = std::sqrt(1.6);
  for (std::size_t k = 0; k < wall.at("area").size(); ++k) {
    EXPECT_NEAR(wall.at("C_p")[k], (wall.at("pressure")[k] - 1.1) / q, 1e-14);
    EXPECT_NEAR(wall.at("C_f")[k], wall.at("shear_stress")[k] / q, 1e-14);
    EXPECT_NEAR(wall.at("C_h")[k], wall.at("heat_flux")[k] / (q * speed), 1e-14);
    EXPECT_NEAR(std::hypot(wall.at("n_x")[k], wall.at("n_y")[k]), 1.0, 1e-14);
    // The normal points into the gas, away from the centre of the disc, except for the deviation of a chord.
    EXPECT_GT(wall.at("n_x")[k] * (wall.at("x")[k] + 0.4) + wall.at("n_y")[k] * (wall.at("y")[k] - 0.1),
              0.75);
  }
}

TEST(a_body_on_edges_of_cells, has_the_loads_and_the_arc_length_of_a_solid_box) {
  const std::string square = "name = \"disc\"\nfrom = [-1, -0.5]\nto = [0, 0.5]\n";
  const simulation a = finished(
                       open_stream + "[[space.body]]\nshape = \"box\"\n" + square + box + loads_of_stream,
                       {"time.end=0.05"}),
                   b = finished(open_stream + "[[space.solid]]\n" + square + box + loads_of_stream,
                                {"time.end=0.05"});
  const auto load = [](const simulation& run) {
    for (const body_load& one : body_loads(run.setup(), run.last()))
      if (one.name == "disc") return one;
    return body_load{};
  };
  EXPECT_NEAR(load(a).force[0], load(b).force[0], 1e-12);
  EXPECT_NEAR(load(a).torque[0], load(b).torque[0], 1e-12);
  const columns wall = columns_of(table_of(a, "disc"));
  ASSERT_EQ(wall.at("s").size(), 16U);
  EXPECT_NEAR(wall.at("s").front(), 0.125, 1e-14);
  EXPECT_NEAR(wall.at("s").back(), 3.875, 1e-14);
  EXPECT_NEAR(wall.at("x").front(), 0.0, 1e-14);
}

TEST(tables_of_concave_bodies, follow_the_wall_from_piece_to_piece) {
  // The bodies are a slot that opens to the right and a disc on the floor.
  const std::string bodies = R"toml(
[[space.body]]
name = "slotted"
shape = "difference"
shapes = [{ shape = "circle", centre = [0, 0.4], radius = 1.1 }, { shape = "box", from = [-0.2, -0.1], to = [2, 0.9] }]
[[space.body]]
name = "mound"
shape = "circle"
centre = [-1.2, -2]
radius = 0.6
)toml";
  const simulation run = finished(open_stream + bodies + loads_of_stream, {"time.end=0"});
  for (const std::string name : {"slotted", "mound"}) {
    const surface_table table = table_of(run, name);
    const columns wall = columns_of(table);
    for (std::size_t k = 1; k < table.corners.size(); ++k) {
      EXPECT_EQ(table.corners[k].front(), table.corners[k - 1].back());
      EXPECT_NEAR(wall.at("s")[k] - wall.at("s")[k - 1], 0.5 * (wall.at("area")[k] + wall.at("area")[k - 1]),
                  1e-14);
    }
    // The first piece is on the right outside, and the pieces run upwards.
    EXPECT_GT(wall.at("n_x").front(), 0.3);
    EXPECT_GT(wall.at("y")[1], wall.at("y")[0]);
  }
  const surface_table mound = table_of(run, "mound"), slotted = table_of(run, "slotted");
  EXPECT_EQ(mound.corners.front().front()[1], -2.0);
  EXPECT_EQ(mound.corners.back().back()[1], -2.0);
  EXPECT_EQ(slotted.corners.front().front(), slotted.corners.back().back());
}

}  // namespace body_tables_test
