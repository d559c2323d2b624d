// Tables [[space.body]]: nested shapes, units and formulas, round trips through documents, and bad input.
#include <apsis/config/body_reader.hpp>
#include <apsis/config/case.hpp>
#include <apsis/config/case_json.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/mesh/cut_cells.hpp>

#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace bodies_test {
namespace {

/// Returns a case of a gas in a square of side 4 with these tables of bodies.
std::string with(const std::string& bodies, const std::string& more = "") {
  return R"([parameters]
r = 0.7
[model]
name = "bgk"
epsilon = 0.1
[initial]
rho = 1
T = 1
[space]
cells = [24, 24]
domain = [[-2, 2], [-2, 2]]
boundary = "outflow"
)" + more +
         bodies +
         R"(
[velocity]
max = 5
points = 6
[time]
method = "md-imex-3-2"
end = 1
safety = 1
)";
}

double gas_volume(const apsis::grid& mesh) {
  double volume = 0.0;
  for (int cell = 0; cell < mesh.size(); ++cell)
    if (mesh.solid(cell) < 0) volume += mesh.gas_share(cell) * mesh.cell_volume();
  return volume;
}

const std::string circle = "[[space.body]]\nshape = \"circle\"\ncentre = [0.01, 0]\nradius = \"r\"\n";

}  // namespace

TEST(bodies, cut_the_mesh_of_their_case) {
  const auto config = apsis::parse_case(with(circle + "T = \"1 + 0.1*x\"\nname = \"disc\"\n"), "flow.toml");
  ASSERT_EQ(config.bodies.size(), 1U);
  EXPECT_EQ(config.bodies[0].name, "disc");
  const apsis::grid mesh = apsis::make_mesh(config);
  ASSERT_NE(mesh.cut(), nullptr);
  EXPECT_EQ(mesh.obstacles(), 1);
  // The cells replace the arc by shorter chords, which changes the area by less than 0.02.
  EXPECT_NEAR(gas_volume(mesh), 16.0 - std::numbers::pi * 0.49, 0.02);
  // A case and its copies share the cut cells.
  const apsis::case_config copy = config;
  EXPECT_EQ(apsis::make_mesh(copy).cut(), mesh.cut());
}

TEST(bodies, follow_parameters_and_overrides) {
  const auto volume = [&](const std::vector<std::string>& overrides) {
    return gas_volume(apsis::make_mesh(apsis::parse_case(with(circle), "flow.toml", overrides)));
  };
  EXPECT_NEAR(volume({"parameters.r=1"}), 16.0 - std::numbers::pi, 0.03);
  EXPECT_NEAR(volume({"space.body.1.radius=0.5"}), 16.0 - 0.25 * std::numbers::pi, 0.02);
}

TEST(bodies, combine_shapes_of_shapes) {
  // The shape is a ring that is open to the right: a circle minus a smaller circle and a box.
  const auto config = apsis::parse_case(with("[[space.body]]\nshape = \"difference\"\nshift = [0.1, "
                                             "0]\nshapes = [{ shape = \"circle\", centre = [0, "
                                             "0], radius = 1.5 }, { shape = \"union\", shapes = [{ shape = "
                                             "\"circle\", centre = [0, 0], radius = 0.8 "
                                             "}, { shape = \"box\", from = [0, -0.4], to = [2, 0.4] }] }]\n"),
                                        "flow.toml");
  const apsis::grid mesh = apsis::make_mesh(config);
  const auto solid = [&](double x, double y) {
    return mesh.solid(static_cast<int>((x + 2.0) * 6.0) * 24 + static_cast<int>((y + 2.0) * 6.0)) >= 0;
  };
  EXPECT_TRUE(solid(-1.05, 0.05));
  EXPECT_TRUE(solid(0.1, 1.15));
  EXPECT_FALSE(solid(0.1, 0.05));
  EXPECT_FALSE(solid(1.3, 0.05));
}

TEST(bodies, of_a_formula_are_those_of_the_shape) {
  const auto config = apsis::parse_case(
      with("[[space.body]]\nshape = \"formula\"\nphi = \"sqrt((x - 0.01)^2 + y^2) - r\"\n"), "flow.toml");
  const auto same = apsis::parse_case(with(circle), "flow.toml");
  const apsis::grid a = apsis::make_mesh(config), b = apsis::make_mesh(same);
  ASSERT_EQ(a.cut()->groups().size(), b.cut()->groups().size());
  EXPECT_NEAR(gas_volume(a), gas_volume(b), 1e-12);
}

TEST(bodies, are_written_so_that_they_read_back) {
  for (const std::string& body :
       {circle + "velocity = [\"-y\", \"x - 0.01\"]\n",
        std::string(
            "[[space.body]]\nname = \"wing\"\nshape = \"polygon\"\npoints = [[-1, -0.5], [1, 0], [-1, 0.5]]\n"
            "rotate = 20\n[[space.body]]\nshape = \"union\"\nshapes = [{ shape = \"ellipse\", centre = [0, "
            "1.4], semi_axes = [0.7, 0.4], angle = 30 }]\n")}) {
    const auto config = apsis::parse_case(with(body), "flow.toml");
    const auto again = apsis::parse_case(apsis::to_toml(config), "again.toml");
    EXPECT_EQ(config.bodies, again.bodies);
    EXPECT_EQ(apsis::to_json(config)["space"]["body"], apsis::to_json(again)["space"]["body"]);
  }
}

}  // namespace bodies_test
