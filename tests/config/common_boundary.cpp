// The table [boundary.all]: which faces take its kind and its variables.
#include <apsis/config/boundary_reader.hpp>
#include <apsis/config/case.hpp>
#include <apsis/config/case_explanation.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/core/text_file.hpp>

#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/folder.hpp>

namespace common_boundary_test {

using namespace apsis;
using testing::HasSubstr;
using testing::IsEmpty;

namespace {

using formulas = std::vector<std::string>;

constexpr std::size_t left = 0, right = 1, bottom = 2, top = 3;

std::string in_the_plane(const std::string& boundaries, const std::string& space = "") {
  return R"toml([model]
name = "bgk"
velocity_dimensions = 2
degrees_of_freedom = 3
epsilon = 0.1
[initial]
rho = 1
T = 1
[space]
cells = [8, 8]
formulation = "finite-difference"
limiter = "positivity"
)toml" + space +
         R"toml([velocity]
max = 7
points = 16
[time]
method = "md-imex-6-3"
end = 0.1
safety = 1
)toml" + boundaries;
}

const std::string far_field = "[boundary.all]\nkind = \"far-field\"\nrho = 1\nu = [0.5, 0]\nT = 1\n";

}  // namespace

TEST(common_boundary, gives_kind_and_values_to_every_face) {
  const case_config config = parse_case(in_the_plane(far_field), "c.toml");
  EXPECT_EQ(config.space.boundary, "far-field");
  for (const std::size_t face : {left, right, bottom, top}) {
    EXPECT_FALSE(config.faces[face].kind) << face_names[face];
    EXPECT_EQ(config.faces[face].values.at("T"), formulas{"1"});
    EXPECT_EQ(config.faces[face].values.at("u"), (formulas{"0.5", "0"}));
  }
  EXPECT_THAT(config.faces[4].values, IsEmpty());
  // The written case has tables of faces, and is the same case.
  const std::string written = to_toml(config);
  EXPECT_THAT(written, HasSubstr("boundary = \"far-field\""));
  EXPECT_EQ(parse_case(written, "again").faces, config.faces);
  EXPECT_THAT(explanation_text(config), HasSubstr("boundary.all.T"));
}

TEST(common_boundary, leaves_faces_with_their_own_kind_alone) {
  const case_config config =
      parse_case(in_the_plane(far_field + "[boundary.right]\nkind = \"outflow\"\n[boundary.bottom]\nkind = "
                                          "\"symmetry\"\n"),
                 "c.toml");
  EXPECT_THAT(config.faces[right].values, IsEmpty());
  EXPECT_THAT(config.faces[bottom].values, IsEmpty());
  EXPECT_EQ(config.faces[left].values, config.faces[top].values);
  EXPECT_EQ(config.faces[top].values.size(), 3U);
}

TEST(common_boundary, is_overridden_by_the_variables_of_a_face) {
  const std::string text = in_the_plane(far_field + "[boundary.top]\nT = 2\n");
  const case_config config = parse_case(text, "c.toml", {"boundary.left.T=3"});
  EXPECT_EQ(config.faces[top].values.at("T"), formulas{"2"});
  EXPECT_EQ(config.faces[top].values.at("rho"), formulas{"1"});
  EXPECT_EQ(config.faces[left].values.at("T"), formulas{"3"});
  EXPECT_EQ(config.faces[right].values.at("T"), formulas{"1"});
  // On the command line too, the table of all faces may change, and either key gives the kind.
  const case_config changed =
      parse_case(text, "c.toml", {"boundary.all.T=4", "boundary.all.u=[0, 0]", "space.boundary=inflow"});
  EXPECT_EQ(changed.faces[left].values.at("T"), formulas{"4"});
  EXPECT_EQ(changed.faces[top].values.at("T"), formulas{"2"});
  EXPECT_EQ(changed.space.boundary, "inflow");
}

TEST(common_boundary, may_have_a_table_in_time_that_one_face_replaces) {
  const test_folder folder;
  const std::string path = folder / "wall.csv";
  write_text_file(path, "t, T\n0, 1\n1, 2\n");
  const case_config config =
      parse_case(in_the_plane(fmt::format("[boundary.all]\nkind = \"diffuse\"\nT = {{ file = \"{}\" }}\n"
                                          "[boundary.left]\nT = 3\n",
                                          path)),
                 "c.toml");
  EXPECT_EQ(config.faces[left].values.at("T"), formulas{"3"});
  EXPECT_THAT(config.faces[right].values.at("T").front(), HasSubstr("table(t, 0, 1, 1, 2)"));
}

TEST(common_boundary, leaves_the_axis_alone) {
  std::string text = in_the_plane("[boundary.all]\nkind = \"far-field\"\nrho = 1\nT = 1\n",
                                  "geometry = \"axisymmetric\"\ndomain = [[0, 1], [0, 1]]\n");
  text.replace(text.find("velocity_dimensions = 2\n"), std::string("velocity_dimensions = 2\n").size(), "");
  text.replace(text.find("points = 16\n"), std::string("points = 16\n").size(),
               "points = 16\nrings = 8\nangles = 12\n");
  const case_config config = parse_case(text, "c.toml");
  EXPECT_EQ(config.faces[bottom].kind, "axis");
  EXPECT_THAT(config.faces[bottom].values, IsEmpty());
  EXPECT_EQ(config.faces[top].values.at("rho"), formulas{"1"});
}

}  // namespace common_boundary_test
