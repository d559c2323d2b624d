// Sets of velocities: the velocities of a row of components, and refused sets.
#include <apsis/velocity/velocity_set.hpp>

#include <apsis/core/errors.hpp>

#include <limits>
#include <numeric>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace velocity_set_test {

namespace {

using apsis::velocity_set;
using testing::ElementsAre;

void make(std::vector<apsis::aligned_vector<double>> coordinates, std::vector<double> weights, int sets = 1) {
  const velocity_set made(std::move(coordinates), std::move(weights), sets);
}

}  // namespace

TEST(velocity_set, every_set_of_components_moves_with_the_velocities) {
  const velocity_set plane({{1.0, -2.0}, {0.0, 0.5}}, {0.25, 0.75}, 3);
  EXPECT_EQ(plane.dimensions(), 2);
  EXPECT_EQ(plane.size(), 2);
  EXPECT_EQ(plane.components(), 6);
  EXPECT_THAT(plane.speeds(0), ElementsAre(1.0, -2.0, 1.0, -2.0, 1.0, -2.0));
  EXPECT_THAT(plane.speeds(1), ElementsAre(0.0, 0.5, 0.0, 0.5, 0.0, 0.5));
  EXPECT_TRUE(plane.speeds(2).empty());
  EXPECT_THAT(plane.weights(), ElementsAre(0.25, 0.75));
}

TEST(velocity_set, none_without_space_and_copies_share_their_numbers) {
  const velocity_set none;
  EXPECT_EQ(none.components(), 0);
  EXPECT_EQ(none.dimensions(), 0);
  EXPECT_TRUE(none.speeds(0).empty());
  const velocity_set line({{1.0}}, {1.0});
  const velocity_set copy = line;  // NOLINT(performance-unnecessary-copy-initialization)
  EXPECT_EQ(copy.speeds(0).data(), line.speeds(0).data());
}

TEST(velocity_set, refuses_what_is_no_set_of_velocities) {
  const double infinite = std::numeric_limits<double>::infinity(),
               nan = std::numeric_limits<double>::quiet_NaN();
  bad_input::expect_refused({
      {[&] { make({}, {}); }, {"0 velocity dimensions"}},
      {[&] { make({{1.0}, {1.0}, {1.0}, {1.0}}, {1.0}); }, {"4 velocity dimensions"}},
      {[&] { make({{1.0, 2.0}}, {1.0}); }, {"2 coordinates for 1 weights"}},
      {[&] { make({{infinite}}, {1.0}); }, {"a velocity is not finite"}},
      {[&] { make({{1.0}}, {nan}); }, {"not a finite number >= 0"}},
      {[&] { make({{1.0}}, {-0.5}); }, {"not a finite number >= 0"}},
      {[&] { make({{1.0}}, {1.0}, 0); }, {"0 sets of components"}},
  });
  EXPECT_NO_THROW(make({{1.0}}, {0.0}));
}

}  // namespace velocity_set_test
