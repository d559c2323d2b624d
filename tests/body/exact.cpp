// Identities of shapes and rotations that hold to the last bit or up to rounding errors.
#include "body/examples.hpp"

#include <apsis/body/rotation.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace exact_test {

namespace {

using namespace body_examples;
using apsis::shape_list;

/// Returns a random number of [−2, 2] with a full significand.
double any_number() {
  return *rc::gen::inRange(-2'000'000'000, 2'000'000'001) / 999'999'937.0;
}

}  // namespace

RC_GTEST_PROP(exact_shapes, a_box_is_zero_on_its_faces, ()) {
  const int dimensions = *rc::gen::inRange(2, 4);
  const auto count = static_cast<std::size_t>(dimensions);
  numbers from, to;
  position x = {};
  for (std::size_t k = 0; k < count; ++k) {
    const double a = any_number(), b = any_number();
    RC_PRE(a != b);
    from.push_back(std::min(a, b));
    to.push_back(std::max(a, b));
    x[k] = std::clamp(any_number(), from[k], to[k]);
  }
  const auto box = made("box", {{"from", from}, {"to", to}}, dimensions);
  const auto k = *rc::gen::inRange<std::size_t>(0, count);
  for (const double face : {from[k], to[k]}) {
    x[k] = face;
    RC_ASSERT(box->outside(x) == 0.0);
    x[k] = std::nextafter(face, face == from[k] ? -10.0 : 10.0);
    RC_ASSERT(box->outside(x) > 0.0);
  }
}

TEST(exact_shapes, functions_of_multiples_of_a_right_angle_are_exact) {
  const double expected[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  for (int n = -9; n <= 9; ++n) {
    const auto [c, s] = apsis::functions_of_degrees(90.0 * n);
    EXPECT_EQ(c, expected[((n % 4) + 4) % 4][0]) << n;
    EXPECT_EQ(s, expected[((n % 4) + 4) % 4][1]) << n;
  }
  for (double degrees = -720.0; degrees <= 720.0; degrees += 7.3) {
    const auto [c, s] = apsis::functions_of_degrees(degrees);
    // The argument in radians has a rounding error of 2e-15, which changes cosine and sine by at
    // most as much.
    EXPECT_NEAR(c, std::cos(degrees * std::numbers::pi / 180.0), 4e-15) << degrees;
    EXPECT_NEAR(s, std::sin(degrees * std::numbers::pi / 180.0), 4e-15) << degrees;
  }
}

TEST(exact_shapes, rotations_by_right_angles_only_permute_coordinates) {
  const auto cuboid = made("box", {{"from", numbers{-0.1, 0.3, 0.7}}, {"to", numbers{1.3, 0.9, 1.7}}}, 3);
  random_points points(3);
  for (int n = 0; n < 1'000; ++n) {
    const position x = points.next();
    const auto about = [&](const numbers& turn) {
      return made("box",
                  {{"from", numbers{-0.1, 0.3, 0.7}}, {"to", numbers{1.3, 0.9, 1.7}}, {"rotate", turn}}, 3);
    };
    // The keys rotate the bodies forwards, so the point rotates backwards.
    EXPECT_EQ(about({0, 0, 2, 90})->outside(x), cuboid->outside({x[1], -x[0], x[2]}));
    EXPECT_EQ(about({0.5, 0, 0, 90})->outside(x), cuboid->outside({x[0], x[2], -x[1]}));
    EXPECT_EQ(about({0, 1, 0, -90})->outside(x), cuboid->outside({x[2], x[1], -x[0]}));
    EXPECT_EQ(about({0, 1, 0, 180})->outside(x), cuboid->outside({-x[0], x[1], -x[2]}));
    EXPECT_EQ(about({0, -1, 0, 720})->outside(x), cuboid->outside(x));
    const auto flat = made("box", {{"from", numbers{-0.1, 0.3}}, {"to", numbers{1.3, 0.9}}}, 2);
    const auto flat_turned =
        made("box", {{"from", numbers{-0.1, 0.3}}, {"to", numbers{1.3, 0.9}}, {"rotate", -270.0}}, 2);
    EXPECT_EQ(flat_turned->outside({x[0], x[1], 0.0}), flat->outside({x[1], -x[0], 0.0}));
  }
}

TEST(exact_shapes, rotations_preserve_lengths_and_their_inverse_undoes_them) {
  const apsis::rotation turn({2.0 / 7, 3.0 / 7, 6.0 / 7}, 73.0);
  random_points points(3);
  for (int n = 0; n < 100; ++n) {
    const position x = points.next(), y = turn.apply(x), z = turn.apply_inverse(y);
    EXPECT_NEAR(std::hypot(x[0], x[1], x[2]), std::hypot(y[0], y[1], y[2]), 2e-15);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(z[k], x[k], 2e-15);
  }
}

TEST(exact_shapes, the_laws_of_de_morgan_hold_to_the_last_bit) {
  const auto both = circles();
  shape_list hollows;
  for (const auto& one : both) hollows.push_back(made("hollow", {{"of", shape_list{one}}}, 2));
  const auto united = made("union", {{"shapes", both}}, 2),
             common = made("intersection", {{"shapes", both}}, 2);
  const auto hollow_union = made("hollow", {{"of", shape_list{united}}}, 2);
  const auto hollow_common = made("hollow", {{"of", shape_list{common}}}, 2);
  const auto common_hollows = made("intersection", {{"shapes", hollows}}, 2);
  const auto united_hollows = made("union", {{"shapes", hollows}}, 2);
  const auto difference = made("difference", {{"shapes", both}}, 2);
  const auto cut = made("intersection", {{"shapes", shape_list{both[0], hollows[1]}}}, 2);
  random_points points(2);
  for (int n = 0; n < 1'000; ++n) {
    const position x = points.next();
    EXPECT_EQ(hollow_union->outside(x), common_hollows->outside(x));
    EXPECT_EQ(hollow_common->outside(x), united_hollows->outside(x));
    EXPECT_EQ(difference->outside(x), cut->outside(x));
  }
}

TEST(exact_shapes, a_turned_circle_is_a_sphere_and_an_extruded_one_a_cylinder) {
  const shape_list on_axis = {made("circle", {{"centre", numbers{0.2, 0.0}}, {"radius", 0.6}}, 2)};
  const auto turned = made("turned", {{"of", on_axis}}, 3);
  const auto sphere = made("sphere", {{"centre", numbers{0.2, 0, 0}}, {"radius", 0.6}}, 3);
  const auto extruded = made("extruded", {{"of", on_axis}, {"from", -0.5}, {"to", 0.5}}, 3);
  const auto endless = made("extruded", {{"of", on_axis}}, 3);
  const apsis::shape_values rod = {
      {"centre", numbers{0.2, 0, 0}}, {"axis", numbers{0, 0, 1}}, {"radius", 0.6}, {"length", 1.0}};
  apsis::shape_values endless_rod = rod;
  endless_rod.erase("length");
  const auto cylinder = made("cylinder", rod, 3), endless_cylinder = made("cylinder", endless_rod, 3);
  random_points points(3);
  for (int n = 0; n < 1'000; ++n) {
    const position x = points.next();
    // Lengths of size 2 have rounding errors of a few 1e-16.
    EXPECT_NEAR(turned->outside(x), sphere->outside(x), 2e-15);
    EXPECT_NEAR(extruded->outside(x), cylinder->outside(x), 2e-15);
    EXPECT_NEAR(endless->outside(x), endless_cylinder->outside(x), 2e-15);
  }
}

}  // namespace exact_test
