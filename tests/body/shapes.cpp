// Signs and distances of all shapes agree with independent formulas.
#include "body/examples.hpp"

#include <apsis/core/errors.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace shapes_test {

namespace {

using namespace body_examples;

double distance(const position& a, const position& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Returns R y for the rotation R about a unit axis, by the half-angle formula of quaternions.
position turned_by(double degrees, const position& axis, const position& y) {
  const double half = degrees * std::numbers::pi / 360.0, w = std::cos(half), s = std::sin(half);
  const position q = {s * axis[0], s * axis[1], s * axis[2]};
  const auto cross = [](const position& a, const position& b) {
    return position{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const position t = cross(q, y), u = cross(q, t);
  return {y[0] + 2.0 * (w * t[0] + u[0]), y[1] + 2.0 * (w * t[1] + u[1]), y[2] + 2.0 * (w * t[2] + u[2])};
}

/// Returns the length of the gradient by central differences.
double slope_of(const apsis::shape& of, const position& x, int dimensions) {
  constexpr double h = 1e-5;
  double sum = 0.0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k) {
    position above = x, below = x;
    above[k] += h;
    below[k] -= h;
    sum += square((of.outside(above) - of.outside(below)) / (2.0 * h));
  }
  return std::sqrt(sum);
}

/// Returns a point with φ = 0 between a point of the gas and one of the body, by bisection.
position surface_point(const apsis::shape& of, position gas, position body) {
  for (int n = 0; n < 60; ++n) {
    const position middle = {0.5 * (gas[0] + body[0]), 0.5 * (gas[1] + body[1]), 0.5 * (gas[2] + body[2])};
    (of.outside(middle) > 0.0 ? gas : body) = middle;
  }
  return body;
}

}  // namespace

TEST(shapes, every_kind_but_surfaces_from_files_has_an_example) {
  std::set<std::string> shown = {"stl"}, known = {"stl"};
  for (const example& one : all_examples()) shown.insert(one.name);
  for (const std::string& name : apsis::shape_names()) known.insert(name);
  EXPECT_EQ(shown, known);
}

TEST(shapes, the_sign_is_that_of_an_independent_description) {
  for (const example& one : all_examples()) {
    const auto made_shape = made(one.name, one.values, one.dimensions);
    random_points points(one.dimensions);
    int bodies = 0;
    for (int n = 0; n < 20'000; ++n) {
      const position x = points.next();
      const double phi = made_shape->outside(x);
      if (std::abs(phi) < 1e-12) continue;  // rounding errors of either formula
      ASSERT_EQ(phi <= 0.0, one.is_body(x)) << one.name << ": " << x[0] << ' ' << x[1] << ' ' << x[2];
      bodies += phi <= 0.0 ? 1 : 0;
    }
    // At least 1 % of the points lie on either side.
    EXPECT_GT(bodies, 200) << one.name;
    EXPECT_LT(bodies, 19'800) << one.name;
  }
}

TEST(shapes, the_sign_moves_with_a_shape_that_is_rotated_and_then_shifted) {
  for (example& one : all_examples()) {
    const position axis = one.dimensions == 2 ? position{0, 0, 1} : position{1.0 / 3, 2.0 / 3, 2.0 / 3};
    const position shift = {0.3, -0.2, one.dimensions == 2 ? 0.0 : 0.5};
    one.values["shift"] = one.dimensions == 2 ? numbers{0.3, -0.2} : numbers{0.3, -0.2, 0.5};
    if (one.dimensions == 2)
      one.values["rotate"] = 127.0;
    else
      one.values["rotate"] = numbers{1.0, 2.0, 2.0, 127.0};
    const auto moved = made(one.name, one.values, one.dimensions);
    random_points points(one.dimensions);
    for (int n = 0; n < 5'000; ++n) {
      const position y = points.next(), r = turned_by(127.0, axis, y);
      const double phi = moved->outside({r[0] + shift[0], r[1] + shift[1], r[2] + shift[2]});
      if (std::abs(phi) < 1e-12) continue;
      ASSERT_EQ(phi <= 0.0, one.is_body(y)) << one.name;
    }
  }
}

TEST(shapes, distances_change_at_most_as_fast_as_the_point_moves) {
  for (const example& one : all_examples()) {
    if (!one.is_distance) continue;
    const auto made_shape = made(one.name, one.values, one.dimensions);
    random_points points(one.dimensions);
    for (int n = 0; n < 10'000; ++n) {
      const position x = points.next(), y = points.next();
      // Each φ has a rounding error of some 1e-16.
      ASSERT_LE(std::abs(made_shape->outside(x) - made_shape->outside(y)), distance(x, y) + 1e-14)
          << one.name;
    }
  }
}

TEST(shapes, no_shape_has_jumps) {
  for (const example& one : all_examples()) {
    const auto made_shape = made(one.name, one.values, one.dimensions);
    random_points points(one.dimensions);
    for (int n = 0; n < 5'000; ++n) {
      const position x = points.next();
      position y = points.next();
      for (std::size_t k = 0; k < 3; ++k) y[k] = x[k] + 1e-7 * y[k];
      // Approximations of the distance may be steeper than 1. The ratio of the semi-axes, below 10, bounds
      // their slope.
      ASSERT_LE(std::abs(made_shape->outside(x) - made_shape->outside(y)), 10.0 * distance(x, y)) << one.name;
    }
  }
}

TEST(shapes, the_gradient_has_length_one_on_the_surface) {
  for (const example& one : all_examples()) {
    const auto made_shape = made(one.name, one.values, one.dimensions);
    random_points points(one.dimensions);
    int good = 0, all = 0;
    while (all < 300) {
      const position a = points.next(), b = points.next();
      if ((made_shape->outside(a) > 0.0) == (made_shape->outside(b) > 0.0)) continue;
      const position x =
          made_shape->outside(a) > 0.0 ? surface_point(*made_shape, a, b) : surface_point(*made_shape, b, a);
      ASSERT_NEAR(made_shape->outside(x), 0.0, 1e-14) << one.name;
      ++all;
      // Differences have a curvature error of h² and a rounding error of 1e-16/h.
      good += std::abs(slope_of(*made_shape, x, one.dimensions) - 1.0) < 1e-4 ? 1 : 0;
    }
    // Points within h of an edge of the surface have no gradient; some in 10⁴ are that close.
    EXPECT_GE(good, all - 3) << one.name;
  }
}

TEST(shapes, an_ellipsoid_is_continuous_at_its_centre_and_exact_there) {
  const auto flat =
      made("ellipsoid", {{"centre", numbers{0, 0, 0}}, {"semi_axes", numbers{2.0, 0.25, 1.0}}}, 3);
  EXPECT_EQ(flat->outside({0, 0, 0}), -0.25);
  for (const position& direction : {position{1, 0, 0}, position{0, 1, 0}, position{0.6, 0.0, -0.8}})
    // The ratio of the semi-axes, 8, bounds the slope of φ.
    EXPECT_NEAR(flat->outside({1e-9 * direction[0], 1e-9 * direction[1], 1e-9 * direction[2]}), -0.25, 1e-7);
  // On the axes outside, φ is the exact distance from the vertices.
  EXPECT_DOUBLE_EQ(flat->outside({3.0, 0, 0}), 1.0);
  EXPECT_DOUBLE_EQ(flat->outside({0, -1.0, 0}), 0.75);
}

TEST(shapes, an_ellipse_with_equal_semi_axes_is_a_circle) {
  const auto round = made("ellipse", {{"centre", numbers{0.2, 0.1}}, {"semi_axes", numbers{0.7, 0.7}}}, 2);
  const auto circle = made("circle", {{"centre", numbers{0.2, 0.1}}, {"radius", 0.7}}, 2);
  random_points points(2);
  for (int n = 0; n < 1'000; ++n) {
    const position x = points.next();
    // Quotients of numbers of size 1 have rounding errors of some 1e-16.
    EXPECT_NEAR(round->outside(x), circle->outside(x), 4e-15);
  }
}

TEST(shapes, a_distance_from_edges_and_corners_of_solids_is_exact) {
  const auto box = made("box", {{"from", numbers{0, 0, 0}}, {"to", numbers{1, 1, 1}}}, 3);
  EXPECT_DOUBLE_EQ(box->outside({2, 2, 2}), std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(box->outside({4, 5, 0.5}), 5.0);
  EXPECT_DOUBLE_EQ(box->outside({0.5, 0.75, 0.5}), -0.25);
  const auto rod =
      made("cylinder",
           {{"centre", numbers{0, 0, 0}}, {"axis", numbers{2, 0, 0}}, {"radius", 1.0}, {"length", 2.0}}, 3);
  EXPECT_DOUBLE_EQ(rod->outside({4, 5, 0}), 5.0);
  EXPECT_DOUBLE_EQ(rod->outside({0.75, 0, 0}), -0.25);
  EXPECT_DOUBLE_EQ(rod->outside({0, 0, 3}), 2.0);
}

TEST(shapes, a_formula_without_a_finite_value_is_an_error) {
  const auto bad = made("formula", {{"phi", [](const position& x) { return std::log(x[0]); }}}, 2);
  EXPECT_EQ(bad->outside({1.0, 0.0, 0.0}), 0.0);
  EXPECT_THROW(bad->outside({-1.0, 0.0, 0.0}), apsis::input_error);
  EXPECT_THROW(bad->outside({0.0, 0.0, 0.0}), apsis::input_error);
}

}  // namespace shapes_test
