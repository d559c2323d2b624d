// Several groups of lanes form sums and answer questions, one after the other.
#include <apsis/device/internal/lane_group.hpp>

#include <apsis/device/lane_team.hpp>

#include <cstddef>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lane_group_test {

using apsis::lane_order;
using apsis::lane_team;
using apsis::team_lane;
using group = apsis::kernels::lane_group<team_lane>;

constexpr int lanes = 32, groups = lanes / 8, questions = 3 * groups;

/// A fast lane asks the next question while others still read the last answer. The questions alternate: one
/// group affirms the first, no group the second.
TEST(lane_group, answers_of_a_block_are_those_of_one_question) {
  for (const lane_order order : {lane_order::forward, lane_order::backward, lane_order::random}) {
    lane_team team(lanes, lanes, order);
    std::vector<int> wrong(lanes);
    team.run(0, 1, [&](const team_lane& lane) {
      const group mine{lane, lane.shared()};
      for (int k = 0; k < questions; ++k) {
        const bool affirmed = k % 2 == 0;
        const bool answer = mine.any_of_block(affirmed && mine.group() == (k / 2) % groups);
        if (answer != affirmed) ++wrong[static_cast<std::size_t>(lane.index())];
      }
    });
    EXPECT_THAT(wrong, testing::Each(0));
  }
}

/// A fast lane begins the next sum while others still read the last one. The sum of a group is 8 k plus a
/// number of the group.
TEST(lane_group, totals_are_those_of_one_sum) {
  for (const lane_order order : {lane_order::forward, lane_order::backward, lane_order::random}) {
    lane_team team(lanes, lanes, order);
    std::vector<int> wrong(lanes);
    team.run(0, 1, [&](const team_lane& lane) {
      const group mine{lane, lane.shared()};
      for (int k = 0; k < questions; ++k) {
        const double sum = mine.total(k + mine.place() * mine.group());
        if (sum != 8.0 * k + 28.0 * mine.group()) ++wrong[static_cast<std::size_t>(lane.index())];
      }
    });
    EXPECT_THAT(wrong, testing::Each(0));
  }
}

}  // namespace lane_group_test
