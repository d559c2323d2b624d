// Corners of the pieces of wall: areas and normals, and surfaces without holes.
#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>
#include <apsis/mesh/cut_cells.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace wall_corners_test {
namespace {

using apsis::at;
using apsis::cut_cells;
using apsis::grid;
using apsis::outside_function;
using apsis::position;
using apsis::wall_segment;

constexpr std::array<bool, 3> closed = {false, false, false};

outside_function ball(double x, double y, double z, double r) {
  return [=](const position& p) { return std::hypot(p[0] - x, p[1] - y, p[2] - z) - r; };
}

grid plane(int n) {
  return grid(2, {n, n, 1}, {-2, -2, 0}, {2, 2, 1});
}

grid space(int n) {
  return grid(3, {n, n, n}, {-2, -2, -2}, {2, 2, 2});
}

std::array<double, 3> cross(const position& a, const position& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Returns the vector area of a polygon, or the length of a segment times the normal on its right.
std::array<double, 3> vector_area(const std::vector<position>& corners) {
  if (corners.size() == 2) return {corners[1][1] - corners[0][1], corners[0][0] - corners[1][0], 0.0};
  std::array<double, 3> sum{};
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const auto one = cross(corners[k], corners[(k + 1) % corners.size()]);
    for (std::size_t d = 0; d < 3; ++d) sum[d] += 0.5 * one[d];
  }
  return sum;
}

void expect_areas_and_normals(const grid& mesh, const cut_cells& cut) {
  ASSERT_FALSE(cut.walls().empty());
  const std::size_t fewest = mesh.dimensions() == 2 ? 2 : 3;
  // The tolerance covers products of coordinates up to 2 and differences of shares of cells.
  const double rounding = 1e-14;
  for (const auto& wall : cut.walls()) {
    ASSERT_GE(wall.corners.size(), fewest);
    const auto found = vector_area(wall.corners);
    for (std::size_t d = 0; d < 3; ++d) EXPECT_NEAR(found[d], wall.area * wall.normal[d], rounding);
  }
  for (const auto& face : cut.faces()) {
    EXPECT_EQ(face.corners.empty(), face.below >= 0 && face.above >= 0);
    if (face.corners.empty()) continue;
    const auto found = vector_area(face.corners);
    EXPECT_NEAR(found[at(face.direction)], face.below < 0 ? face.area : -face.area, rounding);
  }
}

using side = std::pair<position, position>;

/// Counts the directed sides of all pieces of bodies. An end of a segment counts as a side of one point.
std::map<side, int> sides_of(const cut_cells& cut) {
  std::map<side, int> count;
  for (const auto& wall : cut.walls()) {
    const auto& c = wall.corners;
    if (c.size() == 2) {
      ++count[{c[0], {}}];
      ++count[{position{}, c[1]}];
      continue;
    }
    for (std::size_t k = 0; k < c.size(); ++k) ++count[{c[k], c[(k + 1) % c.size()]}];
  }
  return count;
}

/// Expects that each piece begins exactly where another ends. In space two pieces have each side,
/// in opposite directions.
void expect_no_holes(const grid& mesh, const cut_cells& cut) {
  const auto sides = sides_of(cut);
  int missing = 0;
  for (const auto& [one, count] : sides) {
    const side other = mesh.dimensions() == 3     ? side{one.second, one.first}
                       : one.second == position{} ? side{position{}, one.first}
                                                  : side{one.second, position{}};
    const auto found = sides.find(other);
    missing += count == 1 && found != sides.end() && found->second == 1 ? 0 : 1;
  }
  EXPECT_EQ(missing, 0) << "of " << sides.size();
}

}  // namespace

/// Edges of cells lie in the walls of the slot. On a part of them φ is a rounding error.
TEST(walls_on_edges_of_cells, are_those_of_the_mirrored_body) {
  const auto slotted = [](double from, double to) {
    return [=](const position& p) {
      const double slot = std::max({p[0] + 0.2, from - p[1], p[1] - to});
      return std::max(std::hypot(p[0], p[1]) - 1.2, -slot);
    };
  };
  std::array<double, 2> lengths{};
  std::array<std::size_t, 2> pieces{};
  for (std::size_t k = 0; k < 2; ++k) {
    const cut_cells cut(plane(20), {k == 0 ? slotted(0.0, 0.8) : slotted(-0.8, 0.0)}, closed);
    pieces[k] = cut.walls().size();
    for (const wall_segment& one : cut.walls()) lengths[k] += one.area;
  }
  EXPECT_EQ(pieces[0], pieces[1]);
  EXPECT_NEAR(lengths[0], lengths[1], 1e-12);
}

TEST(moments_of_walls, of_a_uniform_pressure_vanish) {
  const auto largest_moment = [](const cut_cells& cut) {
    double most = 0.0;
    for (int solid = 0; solid < 2; ++solid) {
      std::array<double, 3> sum{};
      for (const wall_segment& one : cut.walls()) {
        if (one.solid != solid) continue;
        for (std::size_t k = 0; k < 3; ++k) {
          const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
          sum[k] +=
              one.area * (one.middle[a] * one.normal[b] - one.middle[b] * one.normal[a] + one.moment[k]);
        }
      }
      for (const double x : sum) most = std::max(most, std::abs(x));
    }
    return most;
  };
  const auto triangle = [](const position& p) {
    return std::max({0.3 * p[0] - p[1] - 0.8, 0.9 * p[0] + 0.4 * p[1] - 0.9, p[1] - p[0] - 0.4});
  };
  const auto cube = [](const position& p) {
    const double a = 0.8 * p[0] + 0.6 * p[1], b = 0.8 * p[1] - 0.6 * p[0];
    return std::max({std::abs(a), std::abs(b), std::abs(p[2] - 0.1)}) - 0.9;
  };
  // The moments are sums of some hundred areas.
  constexpr double rounding = 1e-14;
  for (const int n : {12, 24, 31}) {
    EXPECT_LT(largest_moment(cut_cells(plane(n), {triangle}, closed)), rounding) << n;
    EXPECT_LT(largest_moment(cut_cells(plane(n), {ball(-0.9, 0.1, 0, 0.6), ball(0.9, -0.2, 0, 0.7)}, closed)),
              rounding)
        << n;
  }
  for (const int n : {10, 15}) {
    EXPECT_LT(largest_moment(cut_cells(space(n), {ball(0.03, -0.02, 0.05, 1.2)}, closed)), rounding) << n;
    EXPECT_LT(largest_moment(cut_cells(space(n), {cube}, closed)), rounding) << n;
  }
}

TEST(corners_of_walls, in_the_plane_join_the_pieces_of_every_body) {
  for (const int n : {12, 31}) {
    const grid mesh = plane(n);
    const auto disc = [](double x, double y, double r) {
      return [=](const position& p) { return std::hypot(p[0] - x, p[1] - y) - r; };
    };
    const auto square = [](const position& p) {
      const double a = 0.8 * p[0] + 0.6 * p[1], b = 0.8 * p[1] - 0.6 * p[0];
      return std::max(std::abs(a), std::abs(b)) - 0.9;
    };
    for (const std::vector<outside_function>& bodies :
         {std::vector<outside_function>{disc(0.03, -0.02, 1.1)},
          {disc(-0.4, 0, 0.7), disc(0.5, 0.1, 0.8)},
          {square},
          {[](const position& p) { return 1.5 - std::hypot(p[0], p[1]); }},
          {disc(0, 0, 4.0 / 3.0)}}) {
      const cut_cells cut(mesh, bodies, closed);
      expect_areas_and_normals(mesh, cut);
      expect_no_holes(mesh, cut);
    }
  }
}

TEST(corners_of_walls, in_space_make_surfaces_without_holes) {
  for (const int n : {9, 14}) {
    const grid mesh = space(n);
    for (const std::vector<outside_function>& bodies :
         {std::vector<outside_function>{ball(0.03, -0.02, 0.05, 1.2)},
          {ball(-0.4, 0, 0, 0.9), ball(0.5, 0.1, 0.2, 0.9)},
          {[](const position& p) { return 1.6 - std::hypot(p[0], p[1], p[2]); }},
          {ball(0, 0, 0, 4.0 / 3.0)}}) {
      const cut_cells cut(mesh, bodies, closed);
      expect_areas_and_normals(mesh, cut);
      expect_no_holes(mesh, cut);
    }
  }
}

TEST(corners_of_walls, at_boxes_and_faces_of_the_domain_have_the_areas_of_their_pieces) {
  const grid flat = plane(16).with_solids({{{0, 6, 0}, {7, 4, 1}}});
  expect_areas_and_normals(flat, cut_cells(flat, {ball(0.05, 0.1, 0, 1.1)}, closed));
  expect_areas_and_normals(flat, cut_cells(flat, {ball(1.9, -1.8, 0, 1.3)}, closed));
  const grid deep = space(8).with_solids({{{0, 3, 2}, {3, 2, 4}}});
  expect_areas_and_normals(deep, cut_cells(deep, {ball(0.05, 0.1, 0.2, 1.3)}, closed));
  expect_areas_and_normals(deep, cut_cells(deep, {ball(1.9, -1.8, 2, 1.7)}, closed));
}

TEST(corners_of_walls, of_random_bodies_have_the_areas_of_their_pieces) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-1.3, 1.3), size(0.5, 0.9);
  int made = 0;
  for (int k = 0; k < 30; ++k) {
    std::vector<outside_function> bodies;
    for (int b = 0; b < 3; ++b)
      bodies.push_back(ball(place(random), place(random), k % 2 == 0 ? 0.0 : place(random), size(random)));
    const grid mesh = k % 2 == 0 ? plane(40) : space(13);
    try {
      const cut_cells cut(mesh, bodies, closed);
      expect_areas_and_normals(mesh, cut);
      ++made;
    } catch (const apsis::input_error&) {
      continue;  // a gap between two of them is too thin
    }
  }
  EXPECT_GT(made, 7);
}

}  // namespace wall_corners_test
