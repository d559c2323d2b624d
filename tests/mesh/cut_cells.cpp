// Cells that bodies cut: exact volumes and areas, closed surfaces, small cells.
#include <apsis/mesh/cut_cells.hpp>

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mesh/cut_meshes.hpp>
#include <support/bad_input.hpp>

namespace cut_cells_test {

TEST(cut_cells, of_a_half_space_have_exact_volumes_and_centroids) {
  // The cut of a plane is exact at any position.
  for (const double angle : {0.0, 0.3, std::numbers::pi / 4, 2.0, 4.4}) {
    const grid mesh = plane(9);
    const std::array<double, 3> n = {std::cos(angle), std::sin(angle), 0.0};
    const cut_cells cut(mesh, {half_space(n, 0.123)}, closed);
    expect_sound(mesh, cut);
    // The volume of gas of the square is a fine sum over the clipped parts of lines.
    double volume = 0.0, moment = 0.0;
    constexpr int fine = 20000;
    for (int k = 0; k < fine; ++k) {
      // The lines run along x or along y, so that the plane crosses them.
      const bool along_x = std::abs(n[0]) > std::abs(n[1]);
      const double other = -2.0 + 4.0 * (k + 0.5) / fine, a = along_x ? n[0] : n[1],
                   b = along_x ? n[1] : n[0];
      const double zero = std::clamp((0.123 - b * other) / a, -2.0, 2.0);
      const double from = a > 0 ? zero : -2.0, to = a > 0 ? 2.0 : zero;
      volume += (to - from) * 4.0 / fine;
      moment += (along_x ? 0.5 * (to * to - from * from) : (to - from) * other) * 4.0 / fine;
    }
    EXPECT_NEAR(gas_volume(mesh, cut), volume, 1e-6) << angle;  // error of the fine sum
    double found = 0.0;
    for (int cell = 0; cell < mesh.size(); ++cell)
      if (cut.group_of(cell) < 0 && cut.body_of(cell) < 0) found += mesh.cell_volume() * mesh.centre(cell)[0];
    for (const auto& group : cut.groups()) found += group.volume * group.centre[0];
    EXPECT_NEAR(found, moment, 1e-6) << angle;
    for (const auto& wall : cut.walls())
      for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(wall.normal[k], n[k], 1e-12) << angle;
  }
}

TEST(cut_cells, of_a_half_space_in_space_have_exact_volumes) {
  // The plane passes through the middle of the cube, so half of it remains.
  const grid mesh = space(7);
  for (const std::array<double, 3>& n :
       {std::array{1.0, 0.0, 0.0}, {0.6, 0.8, 0.0}, {1.0 / 3, 2.0 / 3, 2.0 / 3}, {0.48, -0.6, 0.64}}) {
    const cut_cells cut(mesh, {half_space(n, 0.0)}, closed);
    expect_sound(mesh, cut);
    EXPECT_NEAR(gas_volume(mesh, cut), 32.0, 1e-10);
    for (const auto& wall : cut.walls())
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(wall.normal[k], n[k], 1e-9);
  }
}

TEST(cut_cells, of_discs_have_volumes_and_lengths_of_second_order) {
  double volume = 0.0, length = 0.0;
  for (const int n : {20, 40, 80}) {
    const grid mesh = plane(n);
    const cut_cells cut(mesh, {disc(0.117, -0.043, 1.0)}, closed);
    expect_sound(mesh, cut);
    const double of_volume = gas_volume(mesh, cut) - (16.0 - std::numbers::pi),
                 of_length = wall_area(cut) - 2.0 * std::numbers::pi;
    if (n > 20) {
      EXPECT_NEAR(order_of(volume, of_volume), 2.0, 0.2);
      EXPECT_NEAR(order_of(length, of_length), 2.0, 0.2);
    }
    volume = of_volume;
    length = of_length;
  }
  // A chord of length h is shorter than its arc by a share (h/R)²/24. Chords of cells have lengths between 0
  // and √2 h.
  const double h = 4.0 / 80;
  EXPECT_LT(std::abs(length), 2.0 * std::numbers::pi * h * h / 24 * 2.0);
}

TEST(cut_cells, of_balls_have_volumes_and_areas_of_second_order) {
  double volume = 0.0, area = 0.0;
  for (const int n : {12, 24, 48}) {
    const grid mesh = space(n);
    const cut_cells cut(mesh, {ball(0.117, -0.043, 0.071, 1.0)}, closed);
    expect_sound(mesh, cut);
    const double of_volume = gas_volume(mesh, cut) - (64.0 - 4.0 / 3.0 * std::numbers::pi),
                 of_area = wall_area(cut) - 4.0 * std::numbers::pi;
    if (n > 12) {
      EXPECT_GT(order_of(volume, of_volume), 1.7);
      EXPECT_GT(order_of(area, of_area), 1.7);
    }
    volume = of_volume;
    area = of_area;
  }
  // The chords of a cell of size h are within 2 h²/(8R) of the ball.
  EXPECT_LT(std::abs(volume), 4.0 * std::numbers::pi / (24.0 * 24.0 / 4.0 * 4.0));
}

TEST(cut_cells, close_the_surface_of_every_body) {
  const grid mesh = plane(40);
  const cut_cells cut(mesh, {disc(-0.9, 0.1, 0.5), turned_square(0.8, -0.3, 0.6, 0.4)}, closed);
  expect_sound(mesh, cut);
  for (int body = 0; body < 2; ++body) {
    std::array<double, 2> sum{};
    double length = 0.0;
    for (const auto& wall : cut.walls())
      if (wall.solid == body) {
        length += wall.area;
        for (std::size_t k = 0; k < 2; ++k) sum[k] += wall.area * wall.normal[k];
      }
    // Chords of the disc are shorter than arcs by a share (h/r)²/24. At a sharp corner a chord is shorter
    // than its two legs by some 0.6 h.
    EXPECT_NEAR(length, body == 0 ? std::numbers::pi : 4.8, body == 0 ? 0.008 : 2.4 * mesh.spacing(0));
    for (const double x : sum) EXPECT_NEAR(x, 0.0, 1e-14);
  }
  // A chord cuts off each sharp corner. The error at a corner is at most the size of a cell.
  const double exact = 16.0 - 0.25 * std::numbers::pi - 1.44;
  EXPECT_NEAR(gas_volume(mesh, cut), exact, 4.0 * mesh.cell_volume());
}

TEST(cut_cells, have_points_of_walls_on_the_surface) {
  const grid mesh = plane(30);
  const auto phi = disc(0.05, 0.02, 1.3);
  const cut_cells cut(mesh, {phi}, closed);
  for (const auto& wall : cut.walls()) {
    EXPECT_NEAR(phi(wall.middle), 0.0, 1e-12);
    // The normal is that of a chord. Its angle to the radius is at most half the angle of the chord.
    const double dot = (wall.middle[0] - 0.05) * wall.normal[0] + (wall.middle[1] - 0.02) * wall.normal[1];
    EXPECT_GT(dot / 1.3, 1.0 - 0.01);
  }
}

TEST(cut_cells, leave_boxes_on_edges_of_cells_whole) {
  const grid mesh = plane(16);
  const cut_cells cut(mesh, {turned_square(0.0, 0.0, 1.0, 0.0)}, closed);
  EXPECT_TRUE(cut.groups().empty());
  int solid = 0;
  for (int cell = 0; cell < mesh.size(); ++cell) solid += cut.body_of(cell) == 0 ? 1 : 0;
  EXPECT_EQ(solid, 64);
}

TEST(cut_cells, have_walls_along_a_surface_through_corners_of_cells) {
  // In cells of size 1/4, φ is exactly 0 at corners. Every face is then open or closed.
  const grid mesh = plane(16);
  for (const double sign : {1.0, -1.0}) {
    const cut_cells cut(mesh, {half_space({1.0, sign, 0}, 0.0)}, closed);
    EXPECT_EQ(gas_volume(mesh, cut), 8.0);
    EXPECT_EQ(cut.walls().size(), 16U);
    EXPECT_NEAR(wall_area(cut), 4.0 * std::numbers::sqrt2, 1e-14);
    for (const auto& wall : cut.walls()) {
      EXPECT_NEAR(wall.normal[0], 0.5 * std::numbers::sqrt2, 1e-15);
      EXPECT_NEAR(wall.normal[1], sign * 0.5 * std::numbers::sqrt2, 1e-15);
      EXPECT_NEAR(wall.middle[0] + sign * wall.middle[1], 0.0, 1e-15);
    }
  }
  const grid deep(3, {8, 8, 8}, {-2, -2, -2}, {2, 2, 2});
  const cut_cells cut(deep, {half_space({1, 0, 1}, 0.0)}, closed);
  EXPECT_EQ(gas_volume(deep, cut), 32.0);
  EXPECT_NEAR(wall_area(cut), 16.0 * std::numbers::sqrt2, 1e-13);
  // The points (±0.6, ±0.8) and (±0.8, ±0.6) of the circle are corners of cells. Chords are shorter than arcs
  // by a share (h/r)²/24.
  EXPECT_NEAR(wall_area(cut_cells(plane(20), {disc(0, 0, 1)}, closed)), 2.0 * std::numbers::pi, 0.02);
}

TEST(cut_cells, have_no_slivers_where_a_body_touches_an_edge) {
  // The disc touches the edges of cells at (±1, 0) and (0, ±1).
  const grid mesh = plane(16);
  const cut_cells cut(mesh, {disc(0.0, 0.0, 1.0)}, closed);
  expect_sound(mesh, cut);
  for (const auto& wall : cut.walls()) EXPECT_GT(wall.area, 0.01 * mesh.spacing(0));
  for (int cell = 0; cell < mesh.size(); ++cell)
    if (cut.group_of(cell) >= 0) {
      EXPECT_LT(std::hypot(mesh.centre(cell)[0], mesh.centre(cell)[1]), 1.0 + mesh.spacing(0));
    }
}

TEST(cut_cells, see_the_same_body_across_periodic_faces) {
  const grid mesh = plane(24);
  const std::array<bool, 3> periodic = {true, true, false};
  // The disc lies across a corner of the domain, with a part at each of the four corners.
  outside_function images = [](const position& x) {
    double least = 10.0;
    for (const double a : {-2.0, 2.0})
      for (const double b : {-2.0, 2.0}) least = std::min(least, disc(a + 0.013, b - 0.021, 0.7)(x));
    return least;
  };
  const cut_cells across(mesh, {images}, periodic), inside(mesh, {disc(0.013, -0.021, 0.7)}, periodic);
  expect_sound(mesh, across);
  ASSERT_EQ(across.groups().size(), inside.groups().size());
  EXPECT_NEAR(gas_volume(mesh, across), gas_volume(mesh, inside), 1e-12);
  const auto distances = [](const cut_cells& cut) {
    std::vector<double> all;
    for (const auto& face : cut.faces())
      all.push_back(std::hypot(face.from_below[0], face.from_below[1]) +
                    std::hypot(face.from_above[0], face.from_above[1]));
    std::sort(all.begin(), all.end());
    return all;
  };
  EXPECT_THAT(distances(across), testing::Pointwise(testing::DoubleNear(1e-11), distances(inside)));
}

TEST(cut_cells, refuse_bodies_that_end_at_a_periodic_face) {
  bad_input::expect_refused({
      {[] { const cut_cells cut(plane(24), {disc(-2.0, 0.1, 0.7)}, {true, false, false}); },
       {"crosses the periodic face at x = -2"}},
  });
}

TEST(cut_cells, are_mirrored_with_the_body) {
  const grid mesh = plane(22);
  std::vector<std::vector<double>> volumes;
  for (const auto& [x, y] : {std::pair{0.31, 0.11}, {-0.31, 0.11}, {0.11, 0.31}, {-0.11, -0.31}}) {
    const cut_cells cut(mesh, {disc(x, y, 0.93)}, closed);
    volumes.emplace_back();
    for (const auto& group : cut.groups()) volumes.back().push_back(group.volume);
    std::sort(volumes.back().begin(), volumes.back().end());
    EXPECT_THAT(volumes.back(), testing::Pointwise(testing::DoubleNear(1e-13), volumes.front()));
  }
}

TEST(cut_cells, of_random_overlapping_bodies_are_sound) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> place(-1.2, 1.2), size(0.3, 0.7);
  int made = 0, refused = 0;
  for (int k = 0; k < 300; ++k) {
    std::vector<outside_function> bodies;
    for (int b = 0; b < 3; ++b) bodies.push_back(disc(place(generator), place(generator), size(generator)));
    const grid mesh = plane(18 + k % 5);
    try {
      const cut_cells cut(mesh, bodies, closed);
      expect_sound(mesh, cut);
      ++made;
    } catch (const apsis::input_error& error) {
      EXPECT_THAT(error.what(),
                  testing::AnyOf(testing::HasSubstr("a gap between bodies is thinner than a cell"),
                                 testing::HasSubstr("(it lies in another body or a solid box)")));
      ++refused;
    }
  }
  EXPECT_GT(made, 200);
  EXPECT_GT(refused, 10);
}

TEST(cut_cells, of_random_bodies_in_space_are_sound) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> place(-0.9, 0.9), size(0.6, 0.9);
  for (int k = 0; k < 10; ++k) {
    const grid mesh = space(11);
    const cut_cells cut(mesh, {ball(place(generator), place(generator), place(generator), size(generator))},
                        closed);
    expect_sound(mesh, cut);
    EXPECT_GT(cut.groups().size(), 20U);
  }
}

TEST(cut_cells, have_mirrored_walls_where_corners_of_cells_lie_on_the_surface) {
  // Corners lie at (±0.6, ±0.8) and (±0.8, ±0.6). There φ is a rounding error of any sign.
  const cut_cells cut(plane(20), {disc(0, 0, 1)}, closed);
  std::array<double, 4> areas{};
  std::array<int, 4> pieces{};
  for (const auto& wall : cut.walls()) {
    const std::size_t quadrant = (wall.middle[0] > 0.0 ? 1U : 0U) + (wall.middle[1] > 0.0 ? 2U : 0U);
    areas[quadrant] += wall.area;
    ++pieces[quadrant];
  }
  for (std::size_t q = 1; q < 4; ++q) {
    EXPECT_EQ(pieces[q], pieces[0]);
    EXPECT_NEAR(areas[q], areas[0], 1e-13);
  }
}

TEST(cut_cells, refuse_functions_that_are_no_bodies) {
  const auto with = [](const outside_function& phi) {
    return [phi] { const cut_cells cut(plane(8), {phi}, closed); };
  };
  bad_input::expect_refused({
      {with([](const position& x) { return std::log(x[0]); }), {"not a number"}},
      {with([](const position&) { return -1.0; }), {"no cell is left"}},
      {with([](const position& x) { return std::abs(x[0]); }), {"a body is thinner than a cell"}},
  });
  bad_input::expect_refused({
      {[] { const cut_cells cut(grid::line(8, 0.0, 1.0), {disc(0, 0, 1)}, closed); }, {"a body on a line"}},
  });
}

TEST(cut_cells, belong_to_the_whole_mesh_that_they_were_made_for) {
  const auto cut_of = [](const grid& mesh) {
    return std::make_shared<const cut_cells>(mesh, std::vector{disc(0.03, 0.01, 1.0)}, closed);
  };
  const grid mesh = plane(16), boxed = mesh.with_solids({{{0, 0, 0}, {2, 2, 1}}});
  const auto cut = [&](const grid& of, const grid& made_for) {
    return [=] { static_cast<void>(of.with_cut_cells(cut_of(made_for))); };
  };
  const std::vector<std::string> block = {
      "a block of a larger mesh cannot be cut (groups of cut cells may reach beyond it); cut the larger "
      "mesh"};
  const std::vector<std::string> other = {
      "the cut cells belong to another mesh (it has other cells or solid boxes); make them for this mesh"};
  bad_input::expect_refused({
      {cut(mesh.block({0, 0, 0}, {16, 8, 1}), mesh), block},
      {cut(mesh.block({4, 0, 0}, {12, 16, 1}), mesh.block({4, 0, 0}, {12, 16, 1})), block},
      {cut(mesh, plane(20)), other},
      {cut(mesh, plane(16, -2.0, 2.5)), other},
      {cut(mesh, boxed), other},
      {cut(boxed, mesh), other},
  });
  // The axis has no part in the cells, and a block with all cells is the mesh itself.
  EXPECT_NO_THROW(cut(boxed, boxed)());
  EXPECT_NO_THROW(cut(mesh.block({0, 0, 0}, {16, 16, 1}), mesh)());
  const grid half(2, {16, 8, 1}, {-2, 0, 0}, {2, 2, 1});
  EXPECT_NO_THROW(cut(half.about_axis(), half)());
}

TEST(cut_cells, have_walls_of_solid_boxes_next_to_them) {
  // A box on edges of cells overlaps a disc.
  const grid mesh = plane(16).with_solids({{{4, 4, 0}, {4, 4, 1}}});
  const cut_cells cut(mesh, {disc(0.2, -0.4, 0.9)}, closed);
  expect_sound(mesh, cut);
  EXPECT_TRUE(
      std::any_of(cut.walls().begin(), cut.walls().end(), [](const auto& w) { return w.solid == 0; }));
  EXPECT_TRUE(
      std::any_of(cut.walls().begin(), cut.walls().end(), [](const auto& w) { return w.solid == 1; }));
}

}  // namespace cut_cells_test
