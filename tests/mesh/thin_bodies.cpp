// Bodies with edges, tips and thin parts. The mesh either resolves them, or refuses them with the required
// number of cells.
#include <apsis/core/errors.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mesh/cut_meshes.hpp>
#include <support/bad_input.hpp>

namespace cut_cells_test {

TEST(thin_bodies, of_turned_bodies_with_edges_are_sound) {
  // The bodies are cubes, cylinders with flat ends, and tetrahedra. An edge may lie between all corners of a
  // face, so that two of them are diagonally in the body.
  std::mt19937 generator(11);
  std::normal_distribution<double> any;
  std::uniform_real_distribution<double> place(-0.1, 0.1);
  const auto size_of = [](const std::array<double, 3>& x) { return std::hypot(x[0], x[1], x[2]); };
  for (int k = 0; k < 30; ++k) {
    std::array<std::array<double, 3>, 3> e{};
    for (auto& axis : e) axis = {any(generator), any(generator), any(generator)};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const double along = e[a][0] * e[b][0] + e[a][1] * e[b][1] + e[a][2] * e[b][2];
        for (std::size_t c = 0; c < 3; ++c) e[a][c] -= along * e[b][c];
      }
      const double length = size_of(e[a]);
      for (double& x : e[a]) x /= length;
    }
    const position shift = {place(generator), place(generator), place(generator)};
    const auto body = [=](const position& at) {
      std::array<double, 3> x{};
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t c = 0; c < 3; ++c) x[a] += e[a][c] * (at[c] - shift[c]);
      switch (k % 3) {
        case 0:
          return std::max({std::abs(x[0]), std::abs(x[1]), std::abs(x[2])}) - 0.8;
        case 1:
          return std::max(std::hypot(x[0], x[1]), std::abs(x[2])) - 0.8;
        default:
          return std::max(
                     {x[0] + x[1] + x[2], x[0] - x[1] - x[2], -x[0] + x[1] - x[2], -x[0] - x[1] + x[2]}) /
                     std::numbers::sqrt3 -
                 0.6;
      }
    };
    const std::array<double, 3> exact = {1.6 * 1.6 * 1.6, 0.64 * 1.6 * std::numbers::pi,
                                         8.0 * std::numbers::sqrt3 * 0.6 * 0.6 * 0.6};
    for (const int n : {12, 24}) {
      const grid mesh = space(n);
      const cut_cells cut(mesh, {body}, closed);
      expect_sound(mesh, cut);
      // At edges, chords cut off up to half of a cell. The edges have a total length of 20, the cells sizes
      // of 1/3 and 1/6.
      const double lost = exact[static_cast<std::size_t>(k % 3)] - (64.0 - gas_volume(mesh, cut));
      EXPECT_NEAR(lost, 0.0, 10.0 * mesh.spacing(0) * mesh.spacing(0)) << k << " " << n;
    }
  }
}

TEST(thin_bodies, refuse_thin_plates_and_gaps_with_the_cells_that_they_need) {
  const auto plate = [](double thickness) {
    return outside_function([=](const position& x) {
      return std::max(std::abs(0.6 * x[0] + 0.8 * x[1]) - 0.5 * thickness,
                      std::abs(0.8 * x[0] - 0.6 * x[1]) - 1.0);
    });
  };
  const auto cut = [](int n, const std::vector<outside_function>& bodies) {
    const cut_cells made(plane(n), bodies, closed);
  };
  const std::string of_plate = bad_input::answer_of([&] { cut(16, {plate(0.1)}); }).message;
  bad_input::expect_refused({{[&] { cut(16, {plate(0.1)}); }, {"a body is thinner than a cell near ("}}});
  const auto advice = of_plate.find("space.cells = [");
  ASSERT_NE(advice, std::string::npos);
  const int needed = std::stoi(of_plate.substr(advice + 15));
  EXPECT_GE(needed, 40);
  EXPECT_LE(needed, 400);
  EXPECT_NO_THROW(cut(needed, {plate(0.1)}));
  // In the first case two discs nearly touch. In the second the corners of a cell enclose gas.
  bad_input::expect_refused({
      {[&] { cut(20, {disc(-0.77, 0.03, 0.7), disc(0.67, 0.03, 0.7)}); },
       {"a gap between bodies is thinner than a cell"}},
  });
  EXPECT_NO_THROW(cut(400, {disc(-0.77, 0.03, 0.7), disc(0.67, 0.03, 0.7)}));
  // A disc lies within a cell.
  bad_input::expect_refused({
      {[&] { cut(4, {disc(0.5, 0.5, 0.2)}); }, {"a body is thinner than a cell"}},
      {[&] { cut(4, {disc(0.7, 0.5, 0.01)}); }, {"body 1 has no wall in the domain"}},
  });
}

TEST(thin_bodies, without_a_wall_are_refused_with_the_reason) {
  const auto cut = [](int n, const std::vector<outside_function>& bodies) {
    return cut_cells(plane(n), bodies, closed);
  };
  // 2 · 4/0.05 cells along the side 4 show 4 cells across the disc.
  bad_input::expect_refused({
      {[&] { cut(4, {disc(0.7, 0.5, 0.05)}); },
       {"body 1 has no wall in the domain (it is about 0.1 thick, and lies between the corners of cells); "
        "enlarge it, or give about space.cells = [160, 160]"}},
      {[&] { cut(4, {disc(0.5, 0.5, 1.2), disc(2.7, 0.5, 0.5)}); },
       {"body 2 has no wall in the domain (it lies outside the domain); move it, or change space.domain"}},
      {[&] { cut(20, {disc(0.1, 0.1, 1.2), disc(0.2, 0.1, 0.5)}); },
       {"body 2 has no wall in the domain (it lies in another body or a solid box); remove it, or move it"}},
  });
  EXPECT_NO_THROW(cut(160, {disc(0.7, 0.5, 0.05)}));
}

TEST(thin_bodies, of_plates_at_any_angle_keep_most_of_the_plate_or_are_refused) {
  std::mt19937 generator(13);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  int made = 0, refused = 0;
  for (int k = 0; k < 300; ++k) {
    const grid mesh = plane(20);
    const double thickness = (0.2 + 2.3 * any(generator)) * mesh.spacing(0), angle = 3.2 * any(generator),
                 x0 = any(generator) * mesh.spacing(0), y0 = any(generator) * mesh.spacing(0);
    const auto plate = [=](const position& x) {
      const double c = std::cos(angle), s = std::sin(angle), dx = x[0] - x0, dy = x[1] - y0;
      return std::max(std::abs(c * dx + s * dy) - 1.0, std::abs(c * dy - s * dx) - 0.5 * thickness);
    };
    try {
      const cut_cells cut(mesh, {plate}, closed);
      // A plate may lose a fifth. Its corners may lose up to half a cell more, as tips may.
      EXPECT_GT(16.0 - gas_volume(mesh, cut), 0.8 * 2.0 * thickness - 0.5 * mesh.cell_volume())
          << thickness << " " << angle;
      ++made;
    } catch (const apsis::input_error& error) {
      EXPECT_THAT(error.what(), testing::AnyOf(testing::HasSubstr("a body is thinner than a cell near"),
                                               testing::HasSubstr("body 1 has no wall in the domain")));
      EXPECT_LT(thickness, 2.0 * mesh.spacing(0));
      ++refused;
    }
  }
  EXPECT_GT(made, 100);
  EXPECT_GT(refused, 50);
}

TEST(thin_bodies, accept_the_tip_of_a_wedge) {
  // The tip of a wedge of 20 degrees vanishes between the corners of two or three cells.
  const outside_function wedge = [](const position& x) {
    const double s = std::sin(std::numbers::pi / 18), c = std::cos(std::numbers::pi / 18);
    return std::max(
        {c * (x[1] - 0.05) + s * (x[0] - 1.27), -c * (x[1] - 0.05) + s * (x[0] - 1.27), -1.1 - x[0]});
  };
  const grid mesh = plane(40);
  const cut_cells cut(mesh, {wedge}, closed);
  expect_sound(mesh, cut);
  EXPECT_GT(cut.thin_cells(), 0);
}

/// A part between a corner inside and a corner outside leaves no trace on any edge.
TEST(thin_bodies, refuse_bodies_that_are_smaller_than_a_cell_or_two) {
  const auto box = [](double a) {
    return [a](const position& x) { return std::max({std::abs(x[0]), std::abs(x[1]), std::abs(x[2])}) - a; };
  };
  const auto refused = [](const grid& mesh, const outside_function& body) {
    try {
      const cut_cells cut(mesh, {body}, closed);
    } catch (const apsis::input_error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("a body is thinner than a cell near"));
      return true;
    }
    return false;
  };
  // The middle of each body is a corner of cells. Cells have the size 0.2, in space 0.4.
  EXPECT_TRUE(refused(plane(20), disc(0, 0, 0.05)));
  EXPECT_TRUE(refused(plane(20), box(0.15)));
  EXPECT_TRUE(refused(space(10), box(0.1)));
  EXPECT_TRUE(refused(space(10), ball(0, 0, 0, 0.3)));
  EXPECT_FALSE(refused(plane(20), disc(0, 0, 0.45)));
  EXPECT_FALSE(refused(space(10), ball(0, 0, 0, 0.9)));
}

}  // namespace cut_cells_test
