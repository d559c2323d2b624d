// Polygons: distances, orientation, and refused input.
#include "body/examples.hpp"

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <support/bad_input.hpp>

namespace polygon_test {

namespace {

using namespace body_examples;

points regular(int sides, double radius) {
  points corners;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / sides;
    corners.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return corners;
}

void make_polygon(const points& corners) {
  made("polygon", {{"points", corners}}, 2);
}

}  // namespace

TEST(polygon, with_many_sides_is_a_circle) {
  constexpr int sides = 1000;
  const auto many = made("polygon", {{"points", regular(sides, 0.8)}}, 2);
  const auto circle = made("circle", {{"centre", numbers{0, 0}}, {"radius", 0.8}}, 2);
  // The surfaces of the polygon and the circle differ by at most r (1 − cos(π/n)).
  const double sagitta = 0.8 * (1.0 - std::cos(std::numbers::pi / sides));
  random_points points(2);
  for (int n = 0; n < 500; ++n) {
    const position x = points.next();
    const double difference = many->outside(x) - circle->outside(x);
    EXPECT_GE(difference, -1e-15);
    EXPECT_LE(difference, sagitta + 1e-15);
  }
}

TEST(polygon, that_is_a_rectangle_equals_a_box) {
  const auto box = made("box", {{"from", numbers{-0.3, 0.1}}, {"to", numbers{0.9, 0.7}}}, 2);
  points corners = {{-0.3, 0.1}, {0.9, 0.1}, {0.9, 0.7}, {-0.3, 0.7}};
  for (const bool backwards : {false, true}) {
    if (backwards) std::reverse(corners.begin(), corners.end());
    const auto rectangle = made("polygon", {{"points", corners}}, 2);
    random_points points(2);
    for (int n = 0; n < 2'000; ++n) {
      const position x = points.next();
      EXPECT_NEAR(rectangle->outside(x), box->outside(x), 1e-15);
    }
    // Rays along x from these points pass through corners or along edges.
    EXPECT_LT(rectangle->outside({0.0, 0.4, 0.0}), 0.0);
    EXPECT_GT(rectangle->outside({-1.0, 0.1, 0.0}), 0.0);
    EXPECT_GT(rectangle->outside({-1.0, 0.7, 0.0}), 0.0);
    for (const auto& corner : corners) EXPECT_EQ(rectangle->outside({corner[0], corner[1], 0.0}), 0.0);
    EXPECT_EQ(rectangle->outside({0.123, 0.7, 0.0}), 0.0);
    EXPECT_EQ(rectangle->outside({0.9, 0.456, 0.0}), 0.0);
  }
}

RC_GTEST_PROP(polygon, of_a_star_contains_the_points_below_its_radius, ()) {
  const int count = *rc::gen::inRange(3, 12);
  points corners;
  for (int k = 0; k < count; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / count, r = *rc::gen::inRange(1, 100) / 50.0;
    corners.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  const auto star = made("polygon", {{"points", corners}}, 2);
  // Each sector is a triangle with a corner at the origin. The point x = s a + t b with s, t ≥ 0 lies inside
  // if s + t < 1.
  const auto k = static_cast<std::size_t>(*rc::gen::inRange(0, count));
  const auto &a = corners[k], &b = corners[(k + 1) % corners.size()];
  const double s = *rc::gen::inRange(1, 100) / 90.0, t = *rc::gen::inRange(1, 100) / 90.0;
  RC_PRE(count > 3 || s + t < 1.0);
  const double phi = star->outside({s * a[0] + t * b[0], s * a[1] + t * b[1], 0.0});
  if (std::abs(s + t - 1.0) > 1e-9) RC_ASSERT((phi <= 0.0) == (s + t < 1.0));
}

TEST(polygon, may_repeat_its_first_point_at_the_end) {
  const auto closed = made("polygon", {{"points", points{{0, 0}, {1, 0}, {0, 1}, {0, 0}}}}, 2);
  const auto open = made("polygon", {{"points", points{{0, 0}, {1, 0}, {0, 1}}}}, 2);
  EXPECT_EQ(closed->outside({0.2, 0.3, 0.0}), open->outside({0.2, 0.3, 0.0}));
}

TEST(polygon, accepts_corners_on_straight_edges) {
  EXPECT_NO_THROW(make_polygon({{0, 0}, {0.1, 0.1}, {0.2, 0.2}, {0.7, 0.7}, {1, 1}, {0, 1}}));
}

TEST(polygon, refuses_edges_that_intersect_and_names_them) {
  bad_input::expect_refused({
      {[&] { make_polygon({{0, 0}, {1, 1}, {1, 0}, {0, 1}}); }, {"edges 1 and 3 that intersect"}},
      // The third edge ends on the first.
      {[&] { make_polygon({{0, 0}, {2, 0}, {2, 1}, {1, 0}, {0, 1}}); }, {"edges 1 and 3 that intersect"}},
      {[&] { make_polygon({{0, 0}, {2, 0}, {1, 0}, {1, 1}}); }, {"edges 1 and 2 that intersect"}},
      {[&] { make_polygon({{0, 0}, {1, 0}, {1, 0}, {0, 1}}); }, {"equal points 2 and 3"}},
      {[&] { make_polygon({{0, 0}, {1, 0}}); }, {"2 points (it needs at least 3)"}},
      {[&] { make_polygon({{0, 0}, {1, 0, 0}, {0, 1}}); }, {"3 components (it needs 2)"}},
  });
}

}  // namespace polygon_test
