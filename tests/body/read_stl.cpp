// Files of surfaces: both formats, and refused input.
#include <apsis/body/read_stl.hpp>

#include "body/triangles.hpp"

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace read_stl_test {

namespace {

using namespace body_triangles;
using apsis::read_stl;
using body_examples::numbers;
using body_examples::random_points;

void read(const std::string& name, const std::string& bytes) {
  const std::string path = written(name, bytes);

  read_stl(path);
}

std::string with(std::string text, const std::string& old, const std::string& replacement) {
  return text.replace(text.find(old), old.size(), replacement);
}

}  // namespace

TEST(read_stl, both_formats_have_the_same_triangles_in_single_precision) {
  const triangle_list sphere = icosphere(0.7, 2);
  const auto ascii = read_stl(written("sphere_ascii.stl", ascii_stl(sphere)));
  const auto binary = read_stl(written("sphere_binary.stl", binary_stl(sphere)));
  EXPECT_EQ(ascii, binary);
  ASSERT_EQ(ascii.size(), sphere.size());
  for (std::size_t t = 0; t < sphere.size(); ++t)
    for (std::size_t n = 0; n < 3; ++n)
      for (std::size_t k = 0; k < 3; ++k)
        ASSERT_EQ(ascii[t][n][k], static_cast<double>(static_cast<float>(sphere[t][n][k])));
}

TEST(read_stl, a_binary_file_may_begin_with_solid_or_not) {
  EXPECT_EQ(read_stl(written("named.stl", binary_stl(unit_cube(), "solid cube\n facet normal"))),
            unit_cube());
  EXPECT_EQ(read_stl(written("plain.stl", binary_stl(unit_cube(), ""))), unit_cube());
}

TEST(read_stl, accepts_capitals_signs_other_line_ends_and_several_solids) {
  std::string text = ascii_stl(unit_cube());
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
  EXPECT_EQ(read_stl(written("capitals.stl", text)), unit_cube());
  EXPECT_EQ(
      read_stl(written("signs.stl", with(ascii_stl(unit_cube()), "vertex 0 1 1", "vertex -0 +1.0e0\t1"))),
      unit_cube());
  std::string windows;
  for (const char c : ascii_stl(unit_cube())) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(read_stl(written("windows.stl", windows)), unit_cube());
  const triangle_list apart = cuboid({2, 2, 2}, {3, 3, 3});
  EXPECT_EQ(read_stl(written("two.stl", ascii_stl(unit_cube()) + "\n" + ascii_stl(apart))),
            joined(unit_cube(), apart));
}

TEST(read_stl, ignores_normals_even_if_they_are_not_finite) {
  EXPECT_EQ(
      read_stl(written("normals.stl", with(ascii_stl(unit_cube()), "normal 0 0 0", "normal nan -inf 0"))),
      unit_cube());
}

TEST(read_stl, refuses_truncated_files) {
  const std::string ascii = ascii_stl(unit_cube()), binary = binary_stl(unit_cube());
  bad_input::expect_refused({
      {[&] { read("cut.stl", ascii.substr(0, ascii.find("endsolid"))); },
       {":86: the file ends before 'endsolid'", "truncated"}},
      {[&] { read("cut.stl", ascii.substr(0, ascii.find("endloop"))); },
       {":7: the file ends before 'endloop'"}},
      {[&] { read("cut.stl", binary.substr(0, binary.size() - 1)); },
       {"the file has 683 bytes (12 triangles at byte 80 need 684)"}},
      {[&] { read("long.stl", binary + " "); }, {"the file has 685 bytes"}},
      {[&] { read("cut.stl", std::string("\1\2\3", 3)); }, {"the file has 3 bytes"}},
  });
}

TEST(read_stl, refuses_empty_files) {
  bad_input::expect_refused({
      {[&] { read("empty.stl", ""); }, {"the file has 0 bytes"}},
      {[&] { read("empty.stl", "solid\nendsolid\n"); }, {"no triangles"}},
      {[&] { read("empty.stl", binary_stl({})); }, {"no triangles"}},
  });
}

TEST(read_stl, refuses_coordinates_that_are_not_finite_numbers) {
  const std::string ascii = ascii_stl(unit_cube());
  const auto changed = [&](const std::string& word) {
    return read("nan.stl", with(ascii, "vertex 0 0 0", "vertex 0 " + word + " 0"));
  };
  bad_input::expect_refused({
      {[&] { changed("nan"); }, {":4: the coordinate nan is not finite"}},
      {[&] { changed("1e39"); }, {":4: the coordinate 1e39 is not finite (in single precision)"}},
      {[&] { changed("1e999"); }, {":4: the coordinate 1e999 is not finite"}},
      {[&] { changed("one"); }, {":4: 'one' is not a number"}},
      {[&] { changed("1.0mm"); }, {":4: '1.0mm' is not a number"}},
  });
  triangle_list triangles = unit_cube();
  triangles[1][2][0] = std::nan("");
  // The position has 84 bytes of the header, 50 of the first triangle, 12 of the normal and 24
  // of two corners.
  bad_input::expect_refused({
      {[&] { read("nan.stl", binary_stl(triangles)); }, {"at byte 170", "in triangle 2"}},
  });
}

TEST(read_stl, refuses_other_texts) {
  const std::string ascii = ascii_stl(unit_cube());
  bad_input::expect_refused({
      {[&] { read("other.stl", with(ascii, "outer", "inner")); }, {":3: 'inner' instead of 'outer'"}},
      {[&] { read("other.stl", with(ascii, "endloop", "vertex")); }, {":7: 'vertex' instead of 'endloop'"}},
      {[&] { read("other.stl", ascii + "more"); }, {":87: 'more' instead of 'solid'"}},
      {[&] { read("other.stl", "v 0 0 0\nv 1 0 0\n"); }, {"neither 'solid' nor"}},
  });
}

TEST(read_stl, reports_files_that_cannot_be_read) {
  EXPECT_THROW(read_stl(testing::TempDir() + "apsis_body_absent.stl"), apsis::io_error);
  EXPECT_THROW(read_stl(testing::TempDir()), apsis::io_error);
}

TEST(read_stl, finds_a_built_in_file_by_its_name) {
  const auto triangles = apsis::read_stl("gas/satellite.stl");
  double volume = 0.0;
  for (const auto& [a, b, c] : triangles)
    volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0])) /
              6.0;
  // The satellite is a box with two panels. Its coordinates have single precision.
  EXPECT_NEAR(volume, 1.2 * 1.2 * 1.2 + 2 * 0.4 * 1.0 * 0.8, 1e-6);
  EXPECT_TRUE(apsis::built_in_stl("gas/satellite.stl")->starts_with("solid satellite\n"));
  // A path other than the built-in name is that of a file.
  EXPECT_THROW(apsis::read_stl("./gas/satellite.stl"), apsis::io_error);
  EXPECT_FALSE(apsis::built_in_stl("gas/satellite"));
}

TEST(shape_stl, is_scaled_rotated_and_then_shifted) {
  const std::string path = written("box.stl", binary_stl(cuboid({0, 0, 0}, {1, 2, 3})));
  const auto stl = body_examples::made(
      "stl",
      {{"file", path}, {"scale", 0.5}, {"rotate", numbers{0, 0, 1, 90}}, {"shift", numbers{0.25, -0.5, 0.0}}},
      3);
  // (x, y) becomes (−y, x), so the box reaches from −1 to 0 along x before it is shifted.
  const auto box =
      body_examples::made("box", {{"from", numbers{-0.75, -0.5, 0.0}}, {"to", numbers{0.25, 0.0, 1.5}}}, 3);
  random_points points(3);
  for (int n = 0; n < 1'000; ++n) {
    const position x = points.next();
    // Both shapes have the same distances, rounded in another order.
    ASSERT_NEAR(stl->outside(x), box->outside(x), 2e-15);
  }
}

TEST(shape_stl, names_the_file_of_an_open_surface) {
  triangle_list triangles = unit_cube();
  triangles.pop_back();
  const std::string path = written("open.stl", ascii_stl(triangles));
  bad_input::expect_refused({{[&] { body_examples::made("stl", {{"file", path}}, 3); },
                              {path + ": the surface is open (3 edges"}}});
  EXPECT_THROW(body_examples::made("stl", {{"file", path + ".absent"}}, 3), apsis::io_error);
}

}  // namespace read_stl_test
