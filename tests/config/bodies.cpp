// Tables [[space.body]]: shapes of shapes, units and formulas, documents that read back, and bad input.
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

/// A gas in a square of side 4 with these tables of bodies.
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

std::string error_of(const std::string& bodies) {
  try {
    apsis::parse_case(with(bodies), "flow.toml");
  } catch (const apsis::input_error& error) {
    return error.what();
  }
  return "";
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
  // The chords of cells are shorter than the arc.
  EXPECT_NEAR(gas_volume(mesh), 16.0 - std::numbers::pi * 0.49, 0.02);
  // The cells are cut once for a case and its copies.
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
  // A ring, open to the right: the difference of two circles and a box.
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

TEST(bodies, refuse_bad_input_with_its_place) {
  const auto message = [](const std::string& text) { return testing::HasSubstr(text); };
  const std::string head = "[[space.body]]\n";
  EXPECT_THAT(error_of(head + "radius = 1\n"), message("key 'space.body.1.shape' is missing"));
  EXPECT_THAT(error_of(head + "shape = \"cirle\"\n"), message("did you mean 'circle'?"));
  EXPECT_THAT(error_of(head + "shape = \"circle\"\ncentre = [0, 0]\n"), message("'radius'"));
  EXPECT_THAT(error_of(head + "shape = \"circle\"\ncentre = [0, 0]\nradius = -1\n"), message("'radius'"));
  EXPECT_THAT(error_of(head + "shape = \"circle\"\ncentre = [0]\nradius = 1\n"), message("'centre'"));
  EXPECT_THAT(error_of(head + "shape = \"sphere\"\ncentre = [0, 0]\nradius = 1\n"), message("sphere"));
  EXPECT_THAT(error_of(circle + "radios = 3\n"), message("unknown key 'space.body.1.radios'"));
  EXPECT_THAT(error_of(circle + "kind = \"inflow\"\nrho = 1\nT = 1\n"),
              message("a body cannot have the wall 'inflow'"));
  const std::string few_velocities = apsis::to_toml(apsis::load_case("benchmarks/broadwell-plane")) +
                                     "[[space.body]]\nshape = \"circle\"\ncentre = [0, 0]\nradius = 0.3\n";
  EXPECT_THAT([&] { apsis::parse_case(few_velocities + "kind = \"symmetry\"\n", "flow.toml"); },
              testing::ThrowsMessage<apsis::input_error>(message("write kind = \"vacuum\"")));
  EXPECT_THAT(
      error_of(circle + "name = \"disc\"\nvelocity = [\"x\", 0]\n"),
      testing::ContainsRegex("body 'disc': the velocity of a wall is -?[0-9.]+ along its normal at t = 0 "
                             "near \\(-?[0-9.]+, -?[0-9.]+\\) \\(the body"));
  EXPECT_EQ(error_of(circle + "kind = \"vacuum\"\n"), "");
  EXPECT_THAT(
      error_of(head + "shape = \"extruded\"\nof = [{ shape = \"circle\", centre = [0, 0], radius = 1 }]\n"),
      message("it is a shape of 3); give the shape in its list 'of' alone"));
  EXPECT_THAT(error_of(circle + "name = \"left\"\n"), message("it is taken"));
  EXPECT_THAT(error_of(circle + circle), message("in another body"));
  EXPECT_THAT(error_of(head + "shape = \"box\"\nfrom = [-1, 0.01]\nto = [1, 0.05]\n"),
              message("is thinner than a cell"));
  EXPECT_THAT(error_of(head + "shape = \"formula\"\nphi = \"x + q\"\n"), message("q"));
  EXPECT_THAT(error_of(head + "shape = \"union\"\nshapes = [{ shape = \"circle\", centre = [0, 0] }]\n"),
              message("'radius'"));
  // Each message begins with its place.
  for (const std::string& bad : {head + "radius = 1\n", circle + "radios = 3\n", circle + circle})
    EXPECT_THAT(error_of(bad), testing::StartsWith("flow.toml:"));
}

TEST(bodies, are_refused_where_they_cannot_be) {
  const auto of = [](const std::string& text) { return [text] { apsis::parse_case(text, "flow.toml"); }; };
  EXPECT_THAT(of("[model]\nname = \"bgk\"\nepsilon = 1\n[initial]\nrho = 1\nT = 1\n[space]\ncells = "
                 "20\n[[space.body]]\nshape = \"box\"\nfrom = [0]\nto = [1]\n[velocity]\nmax = 5\npoints = "
                 "6\n[time]\nend = 1\nsafety = 1\n"),
              testing::ThrowsMessage<apsis::input_error>(testing::HasSubstr("a body on a line")));
  std::string steady = with(circle + "T = \"1 + 0.1*t\"\n");
  steady.replace(steady.find("[time]"), std::string::npos, "[steady]\ntolerance = 1e-6\n");
  EXPECT_THAT(of(steady), testing::ThrowsMessage<apsis::input_error>(
                              testing::HasSubstr("'space.body.1.T' depends on t")));
}

}  // namespace bodies_test
