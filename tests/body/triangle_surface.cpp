// Signed distances of surfaces of triangles agree with those of solids in closed form.
#include <apsis/body/triangle_surface.hpp>

#include "body/triangles.hpp"

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <support/bad_input.hpp>

namespace triangle_surface_test {

namespace {

using namespace body_triangles;
using apsis::triangle_surface;
using body_examples::numbers;
using body_examples::random_points;

std::shared_ptr<const apsis::shape> box_shape_of(const position& low, const position& high) {
  return body_examples::made(
      "box", {{"from", numbers(low.begin(), low.end())}, {"to", numbers(high.begin(), high.end())}}, 3);
}

void expect_unit_cube(const triangle_surface& cube) {
  EXPECT_DOUBLE_EQ(cube.volume(), 1.0);
  EXPECT_DOUBLE_EQ(cube.area(), 6.0);
  EXPECT_EQ(cube.shells(), 1);
  const auto box = box_shape_of({0, 0, 0}, {1, 1, 1});
  random_points points(3);
  for (int n = 0; n < 2'000; ++n) {
    const position x = points.next();
    // Squares of numbers of size 2 and their square roots have rounding errors of 4e-16.
    ASSERT_NEAR(cube.signed_distance(x), box->outside(x), 2e-15);
  }
}

void make(const triangle_list& triangles) {
  const triangle_surface made(triangles);
}

double determinant(const position& a, const position& b, const position& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// Returns the prism over a star with acute corners, between z = 0 and 1, and sets the corners of the star.
triangle_list star_prism(body_examples::points& corners) {
  constexpr int count = 10;
  for (int k = 0; k < count; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / count, r = k % 2 == 0 ? 1.0 : 0.3;
    corners.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  triangle_list triangles;
  for (std::size_t k = 0; k < count; ++k) {
    const auto &p = corners[k], &q = corners[(k + 1) % count];
    const position a = {p[0], p[1], 0}, b = {q[0], q[1], 0}, c = {p[0], p[1], 1}, d = {q[0], q[1], 1};
    triangles.push_back({a, b, d});
    triangles.push_back({a, d, c});
    triangles.push_back({position{0, 0, 1}, c, d});
    triangles.push_back({position{0, 0, 0}, b, a});
  }
  return triangles;
}

}  // namespace

TEST(triangle_surface, of_a_cube_equals_a_box) {
  const triangle_surface cube(unit_cube());
  EXPECT_EQ(cube.triangles(), 12);
  EXPECT_EQ(cube.vertices(), 8);
  expect_unit_cube(cube);
  // Normals of axis-parallel faces are exact.
  EXPECT_EQ(cube.signed_distance({0.3, 0.3, 1.0}), 0.0);
  EXPECT_EQ(cube.signed_distance({0.3, 0.7, 1.25}), 0.25);
  EXPECT_EQ(cube.signed_distance({0.25, 0.4, 0.6}), -0.25);
}

TEST(triangle_surface, of_a_reversed_cube_is_turned_outwards) {
  expect_unit_cube(triangle_surface(reversed(unit_cube())));
}

TEST(triangle_surface, of_a_star_equals_an_extruded_polygon) {
  body_examples::points corners;
  const triangle_surface star(star_prism(corners));
  const auto polygon = body_examples::made("polygon", {{"points", corners}}, 2);
  const auto prism =
      body_examples::made("extruded", {{"of", apsis::shape_list{polygon}}, {"from", 0.0}, {"to", 1.0}}, 3);
  random_points points(3);
  for (int n = 0; n < 5'000; ++n) {
    const position x = points.next();
    // The surfaces have the same corners; distances of size 2 have rounding errors of a few 1e-16.
    ASSERT_NEAR(star.signed_distance(x), prism->outside(x), 4e-15) << x[0] << ' ' << x[1] << ' ' << x[2];
  }
}

TEST(triangle_surface, of_an_icosahedron_has_its_volume_and_area) {
  const triangle_surface solid(icosphere(1.0, 0));
  // a is the edge of an icosahedron with the circumradius 1.
  const double a = 1.0 / std::sin(2.0 * std::numbers::pi / 5.0);
  EXPECT_NEAR(solid.volume(), 5.0 * (3.0 + std::sqrt(5.0)) / 12.0 * a * a * a, 1e-14);
  EXPECT_NEAR(solid.area(), 5.0 * std::sqrt(3.0) * a * a, 1e-14);
  EXPECT_EQ(solid.triangles(), 20);
  EXPECT_EQ(solid.vertices(), 12);
}

TEST(triangle_surface, of_many_triangles_approaches_a_sphere) {
  constexpr double radius = 0.9;
  for (const int levels : {2, 4}) {
    const triangle_surface solid(icosphere(radius, levels));
    EXPECT_EQ(solid.triangles(), 20 << (2 * levels));
    // Edges are at most 1.3 r/2^levels long, so the sagitta below a triangle is at most 0.3 r/4^levels.
    const double sagitta = 0.3 * radius / (1 << (2 * levels));
    random_points points(3);
    for (int n = 0; n < 2'000; ++n) {
      const position x = points.next();
      const double difference = solid.signed_distance(x) - (std::hypot(x[0], x[1], x[2]) - radius);
      ASSERT_GE(difference, -1e-15);
      ASSERT_LE(difference, sagitta);
    }
    const double sphere = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
    EXPECT_LT(solid.volume(), sphere);
    EXPECT_GT(solid.volume(), sphere * (1.0 - 3.0 * sagitta / radius));
  }
}

RC_GTEST_PROP(triangle_surface, of_a_tetrahedron_contains_points_with_positive_barycentric_coordinates, ()) {
  const auto number = [] { return *rc::gen::inRange(-100, 101) / 100.0; };
  std::array<position, 4> p;
  for (position& corner : p) corner = {number(), number(), number()};
  const auto volume = [](const position& a, const position& b, const position& c, const position& d) {
    const auto from_a = [&](const position& x) { return position{x[0] - a[0], x[1] - a[1], x[2] - a[2]}; };
    return determinant(from_a(b), from_a(c), from_a(d)) / 6.0;
  };
  const double whole = volume(p[0], p[1], p[2], p[3]);
  RC_PRE(std::abs(whole) > 1e-4);
  // The constructor turns the surface outwards, also if the volume of the given triangles is negative.
  const triangle_surface solid(
      {{p[0], p[2], p[1]}, {p[0], p[1], p[3]}, {p[1], p[2], p[3]}, {p[2], p[0], p[3]}});
  RC_ASSERT(std::abs(solid.volume() - std::abs(whole)) < 1e-15);
  for (int n = 0; n < 20; ++n) {
    const position x = {number() * 1.01, number() * 1.01, number() * 1.01};
    const double least = std::min({volume(x, p[1], p[2], p[3]), volume(p[0], x, p[2], p[3]),
                                   volume(p[0], p[1], x, p[3]), volume(p[0], p[1], p[2], x)},
                                  [&](double a, double b) { return a / whole < b / whole; }) /
                         whole;
    // Closer to the surface, either formula may have rounding errors of the other sign.
    if (std::abs(least) > 1e-10) RC_ASSERT((solid.signed_distance(x) <= 0.0) == (least > 0.0));
  }
}

TEST(triangle_surface, of_a_solid_with_sharp_spikes_has_the_sign_of_its_tetrahedra_from_the_centre) {
  triangle_list triangles = icosphere(1.0, 3);
  // Equal corners get equal, pseudo-random radii between 0.2 and 1.3.
  for (auto& triangle : triangles)
    for (position& x : triangle) {
      const double seed = std::abs(std::sin(1e4 * (x[0] + 2.3 * x[1] + 5.1 * x[2])));
      const double radius = 0.2 + 1.1 * (1e3 * seed - std::floor(1e3 * seed));
      for (double& component : x) component *= radius;
    }
  const triangle_surface solid(triangles);
  random_points points(3);
  for (int n = 0; n < 3'000; ++n) {
    const position x = points.next();
    // x = α a + β b + γ c with nonnegative coefficients for one of the triangles, by Cramer's rule.
    double sum = -1.0;
    for (const auto& [a, b, c] : triangles) {
      const double whole = determinant(a, b, c), alpha = determinant(x, b, c), beta = determinant(a, x, c),
                   gamma = determinant(a, b, x);
      if (alpha >= 0.0 && beta >= 0.0 && gamma >= 0.0) sum = (alpha + beta + gamma) / whole;
    }
    ASSERT_GE(sum, 0.0);
    if (std::abs(sum - 1.0) < 1e-9) continue;  // rounding errors of either formula
    ASSERT_EQ(solid.signed_distance(x) <= 0.0, sum < 1.0) << x[0] << ' ' << x[1] << ' ' << x[2];
  }
}

TEST(triangle_surface, of_two_solids_is_their_union) {
  const triangle_surface both(joined(unit_cube(), cuboid({2, 0, 0}, {3, 2, 1})));
  EXPECT_EQ(both.shells(), 2);
  EXPECT_DOUBLE_EQ(both.volume(), 3.0);
  const auto first = box_shape_of({0, 0, 0}, {1, 1, 1}), second = box_shape_of({2, 0, 0}, {3, 2, 1});
  random_points points(3);
  for (int n = 0; n < 1'000; ++n) {
    position x = points.next();
    x[0] += 1.5;
    ASSERT_NEAR(both.signed_distance(x), std::min(first->outside(x), second->outside(x)), 2e-15);
  }
}

TEST(triangle_surface, with_a_reversed_shell_inside_has_a_cavity) {
  const triangle_list inner = cuboid({0.25, 0.25, 0.25}, {0.5, 0.5, 0.75});
  for (const bool backwards : {false, true}) {
    triangle_list shells = joined(unit_cube(), reversed(inner));
    if (backwards) shells = reversed(shells);
    const triangle_surface hollow(shells);
    EXPECT_DOUBLE_EQ(hollow.volume(), 1.0 - 0.03125);
    const auto outer = box_shape_of({0, 0, 0}, {1, 1, 1}),
               cavity = box_shape_of({0.25, 0.25, 0.25}, {0.5, 0.5, 0.75});
    random_points points(3);
    for (int n = 0; n < 1'000; ++n) {
      const position x = points.next();
      ASSERT_NEAR(hollow.signed_distance(x), std::max(outer->outside(x), -cavity->outside(x)), 2e-15);
    }
  }
}

TEST(triangle_surface, refuses_shells_whose_orientations_contradict_each_other) {
  const triangle_list inner = cuboid({0.25, 0.25, 0.25}, {0.5, 0.5, 0.75}),
                      apart = cuboid({2, 2, 2}, {3, 2.5, 3});
  bad_input::expect_refused({
      {[&] { make(joined(unit_cube(), inner)); }, {"the part inside the body with the corner"}},
      {[&] { make(joined(unit_cube(), reversed(apart))); }, {"the cavity outside the body"}},
  });
}

TEST(triangle_surface, drops_triangles_with_equal_corners) {
  triangle_list triangles = unit_cube();
  const position a = triangles[0][0], b = triangles[0][1];
  triangles.push_back({a, b, a});
  triangles.push_back({b, b, b});
  const triangle_surface cube(triangles);
  EXPECT_EQ(cube.triangles(), 12);
  expect_unit_cube(cube);
}

TEST(triangle_surface, flips_triangles_with_collinear_corners) {
  // One side of a face has additional points, which flat triangles connect with the neighbouring face.
  triangle_list triangles = unit_cube();
  const position a = triangles[0][0], b = triangles[0][1], x = triangles[0][2];
  const auto between = [&](double t) {
    return position{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
  };
  const position p = between(0.25), q = between(0.7);
  triangles.erase(triangles.begin());
  triangles.insert(triangles.end(), {{a, p, x}, {p, q, x}, {q, b, x}, {a, b, p}, {p, b, q}});
  const triangle_surface cube(triangles);
  EXPECT_EQ(cube.triangles(), 16);
  EXPECT_EQ(cube.vertices(), 10);
  expect_unit_cube(cube);
}

TEST(triangle_surface, refuses_open_edges_and_counts_them) {
  triangle_list triangles = unit_cube();
  triangles.pop_back();
  bad_input::expect_refused({
      {[&] { make(triangles); }, {"the surface is open (3 edges belong to one triangle alone"}},
  });
  triangles.pop_back();
  bad_input::expect_refused({
      {[&] { make(triangles); }, {"the surface is open (4 edges"}},
      {[&] { make({triangles.front()}); }, {"the surface is open (3 edges"}},
  });
}

TEST(triangle_surface, refuses_edges_of_more_than_two_triangles) {
  triangle_list triangles = unit_cube();
  triangles.push_back({triangles[0][0], triangles[0][1], position{0.5, 0.5, 0.5}});
  bad_input::expect_refused({
      {[&] { make(triangles); }, {"the surface branches (1 edge belongs to more than two triangles"}},
      // Two cubes that share an edge.
      {[&] { make(joined(unit_cube(), cuboid({1, 1, 0}, {2, 2, 1}))); },
       {"the surface branches (1 edge belongs"}},
  });
}

TEST(triangle_surface, refuses_neighbours_of_contrary_orientation) {
  triangle_list triangles = unit_cube();
  std::swap(triangles[0][0], triangles[0][1]);
  bad_input::expect_refused({
      {[&] { make(triangles); }, {"no orientation (3 edges have the same direction in both triangles"}},
  });
}

TEST(triangle_surface, refuses_surfaces_without_triangles_or_volume) {
  bad_input::expect_refused({
      {[&] { make({}); }, {"the surface is empty"}},
  });
  const position a = {0, 0, 0}, b = {1, 0, 0}, c = {0, 1, 0};
  bad_input::expect_refused({
      {[&] { make({{a, a, b}}); }, {"0 of its 1 triangles have an area"}},
      {[&] { make({{a, b, c}, {a, c, b}}); }, {"encloses no volume"}},
      {[&] {
         make(joined(unit_cube(), {{a, position{-1, 0, 0}, position{-1, -1, 0}},
                                   {a, position{-1, -1, 0}, position{-1, 0, 0}}}));
       },
       {"encloses no volume"}},
  });
}

}  // namespace triangle_surface_test
