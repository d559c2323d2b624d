// Axes and marginals of velocity sets, computed from their points and weights.
#include <apsis/output/velocity_axes.hpp>

#include <cstddef>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace velocity_axes_test {

namespace {

using apsis::velocity_set;
using testing::DoubleEq;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

/// Returns a tensor product of different nodes with unequal weights along the second axis. The first
/// axis is slowest.
velocity_set plane() {
  return {{{2.0, 2.0, 2.0, -1.0, -1.0, -1.0}, {0.0, 1.0, 3.0, 0.0, 1.0, 3.0}},
          {0.5, 1.0, 0.25, 1.0, 2.0, 0.5}};
}

}  // namespace

TEST(velocity_axes, of_a_tensor_product_are_its_nodes) {
  const auto axes = apsis::velocity_axes(plane());
  ASSERT_THAT(axes, SizeIs(2));
  EXPECT_EQ(axes[0].name, "v_x");
  EXPECT_EQ(axes[1].name, "v_y");
  EXPECT_THAT(axes[0].nodes, ElementsAre(2.0, -1.0));
  EXPECT_THAT(axes[1].nodes, ElementsAre(0.0, 1.0, 3.0));
  // Axis weights have the ratios of the weights of the points. Each end has half an interval.
  EXPECT_THAT(axes[0].weights, ElementsAre(DoubleEq(2.0), DoubleEq(4.0)));
  EXPECT_THAT(axes[1].weights, ElementsAre(DoubleEq(4.5 * 2 / 7), DoubleEq(4.5 * 4 / 7), DoubleEq(4.5 / 7)));
}

TEST(velocity_axes, of_a_line_are_its_points_and_weights) {
  const auto axes = apsis::velocity_axes({{{1.0, 0.0, -1.0}}, {1.0, 2.0, 1.0}});
  ASSERT_THAT(axes, SizeIs(1));
  EXPECT_EQ(axes[0].name, "v");
  EXPECT_THAT(axes[0].nodes, ElementsAre(1.0, 0.0, -1.0));
  EXPECT_THAT(axes[0].weights, ElementsAre(1.0, 2.0, 1.0));
}

TEST(velocity_axes, are_absent_if_the_velocities_are_not_a_grid) {
  EXPECT_THAT(apsis::velocity_axes({}), IsEmpty());
  EXPECT_THAT(apsis::velocity_axes({{{0.0, 2.0, 1.0}}, {1.0, 1.0, 1.0}}), IsEmpty()) << "not monotone";
  EXPECT_THAT(apsis::velocity_axes({{{0.0, 0.0}}, {1.0, 1.0}}), IsEmpty()) << "repeated point";
  EXPECT_THAT(apsis::velocity_axes({{{0.0, 1.0, 0.0, 1.0}, {0.0, 0.0, 1.0, 1.0}}, {1.0, 1.0, 1.0, 1.0}}),
              IsEmpty())
      << "the first axis runs fastest";
  EXPECT_THAT(apsis::velocity_axes({{{0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}}, {1.0, 1.0, 1.0}}), IsEmpty())
      << "a corner is missing";
  EXPECT_THAT(apsis::velocity_axes({{{0.0, 0.0, 1.0, 1.0}, {0.0, 1.0, 0.0, 1.0}}, {1.0, 1.0, 1.0, 2.0}}),
              IsEmpty())
      << "weights are not products";
}

TEST(velocity_points, contain_all_coordinates_of_every_velocity_once) {
  EXPECT_THAT(apsis::velocity_points({{{1.0, -2.0}, {0.0, 0.5}}, {0.25, 0.75}, 3}),
              ElementsAre(1.0, 0.0, -2.0, 0.5));
  EXPECT_THAT(apsis::velocity_points({{{1.0, -1.0}}, {1.0, 1.0}, 2}), ElementsAre(1.0, -1.0));
  EXPECT_THAT(apsis::velocity_points({}), IsEmpty());
}

TEST(marginals, integrate_to_the_density_along_every_axis) {
  const velocity_set set = plane();
  const std::vector<double> f = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 0.5, 0.0, 7.0, 1.0, 0.25, 2.0};
  const auto found = apsis::marginals(f, 2, set);
  ASSERT_THAT(found, SizeIs(2));
  EXPECT_EQ(found[0].label, "f integrated over v_y");
  EXPECT_EQ(found[1].label, "f integrated over v_x");
  for (std::size_t cell = 0; cell < 2; ++cell) {
    double density = 0.0;
    for (std::size_t j = 0; j < 6; ++j) density += set.weights()[j] * f[6 * cell + j];
    for (const auto& one : found) {
      const std::size_t n = one.axis.nodes.size();
      double sum = 0.0;
      for (std::size_t i = 0; i < n; ++i) sum += one.axis.weights[i] * one.values[cell * n + i];
      EXPECT_NEAR(sum, density, 1e-14 * density) << one.axis.name << " " << cell;
    }
  }
  // In the first cell the value at the first node is Σ w f / w_x = (0.5 + 2 + 0.75)/2.
  EXPECT_THAT(found[0].values[0], DoubleNear(1.625, 1e-15));
}

TEST(marginals, are_of_a_function_of_several_velocity_components) {
  EXPECT_THAT(apsis::marginals({1.0, 2.0}, 1, {{{1.0, -1.0}}, {1.0, 1.0}}), IsEmpty());
  EXPECT_THAT(apsis::marginals({1.0, 2.0, 3.0, 4.0}, 1, {{{1.0, -1.0}, {0.0, 0.0}}, {1.0, 1.0}, 2}),
              IsEmpty());
}

}  // namespace velocity_axes_test
