#include <apsis/device/lane_team.hpp>

#include <apsis/device/internal/kernel_table.hpp>
#include <apsis/device/internal/kernels/combine.hpp>
#include <apsis/device/teams.hpp>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lane_team_test {

using apsis::lane_order;
using apsis::lane_team;
using apsis::team_lane;

constexpr lane_order orders[] = {lane_order::forward, lane_order::backward, lane_order::random};

/// Each lane passes its number to the next one, as often as there are lanes. Without waiting in between, the
/// received numbers depend on the order.
std::vector<double> passed_around(lane_order order, bool waits) {
  constexpr int lanes = 7;
  lane_team team(lanes, lanes, order);
  std::vector<double> received(lanes);
  team.run(0, 1, [&](const team_lane& lane) {
    const auto me = static_cast<std::size_t>(lane.index()), next = (me + 1) % lanes;
    double mine = lane.index();
    for (int k = 0; k < lanes; ++k) {
      lane.shared()[next] = 2.0 * mine + 1.0;
      if (waits) lane.wait();
      mine = lane.shared()[me];
      lane.wait();
    }
    received[me] = mine;
  });
  return received;
}

TEST(lane_team, the_order_of_lanes_does_not_change_what_they_compute) {
  for (const lane_order order : orders)
    EXPECT_THAT(passed_around(order, true), testing::ContainerEq(passed_around(lane_order::forward, true)));
}

TEST(lane_team, a_missing_wait_changes_what_they_compute) {
  const auto right = passed_around(lane_order::forward, true);
  for (const lane_order order : orders) {
    const auto wrong = passed_around(order, false);
    EXPECT_NE(wrong, right);
  }
}

TEST(lane_team, random_orders_differ_from_each_other) {
  std::vector<std::vector<int>> seen(2);
  lane_team team(32, 0, lane_order::random);
  for (auto& one : seen) team.run(0, 1, [&](const team_lane& lane) { one.push_back(lane.index()); });
  EXPECT_NE(seen[0], seen[1]);
  EXPECT_THAT(seen[0], testing::UnorderedElementsAreArray(seen[1]));
}

TEST(lane_team, lanes_that_end_while_others_wait_are_an_error) {
  lane_team team(4, 0, lane_order::forward);
  EXPECT_THROW(team.run(0, 1,
                        [](const team_lane& lane) {
                          if (lane.index() != 2) lane.wait();
                        }),
               std::logic_error);
}

TEST(lane_team, shared_numbers_are_unknown_at_the_beginning_of_each_block) {
  lane_team team(2, 3, lane_order::forward);
  for (int block = 0; block < 2; ++block)
    team.run(block, 2, [&](const team_lane& lane) {
      EXPECT_EQ(lane.block(), block);
      EXPECT_EQ(lane.blocks(), 2);
      EXPECT_EQ(lane.count(), 2);
      if (lane.index() == 0) {
        EXPECT_TRUE(std::isnan(lane.shared()[2]));
        lane.shared()[2] = 1.0;
      }
    });
}

TEST(team_device, unwritten_memory_is_not_a_number) {
  const auto on = apsis::make_team_device(lane_order::forward);
  const apsis::stored_numbers numbers(5, on->memory());
  std::vector<double> seen(5);
  on->memory().copy_to_host(numbers.data(), 5, seen.data());
  EXPECT_THAT(seen, testing::Each(testing::IsNan()));
}

/// One term of a sum is not copied to the device.
TEST(team_device, a_missing_copy_leaves_no_number_right) {
  const auto on = apsis::make_team_device(lane_order::forward);
  const std::vector<double> ones(4, 1.0);
  for (const bool copied : {true, false}) {
    apsis::stored_numbers term(4, on->memory()), sum(4, on->memory());
    if (copied) on->memory().copy_from_host(ones.data(), 4, term.data());
    on->launch<apsis::kernels::combine>({2, 2, 0}, {sum.data(), 4, 1, 1, {3.0}, {term.data()}});
    std::vector<double> seen(4);
    on->memory().copy_to_host(sum.data(), 4, seen.data());
    if (copied)
      EXPECT_THAT(seen, testing::Each(3.0));
    else
      EXPECT_THAT(seen, testing::Each(testing::IsNan()));
  }
}

TEST(team_device, refuses_unknown_kernels_and_other_arguments) {
  const auto on = apsis::make_team_device(lane_order::forward);
  const double none = 0.0;
  EXPECT_THROW(on->start("no_kernel", {}, &none, sizeof none), std::logic_error);
  EXPECT_THROW(on->start("combine", {}, &none, sizeof none), std::logic_error);
}

/// Code for graphics processors has an entry for every kernel of the host.
TEST(device_code, has_every_kernel) {
  if (apsis::device_code_objects().empty()) GTEST_SKIP() << "built without clang++-19";
  for (const auto& object : apsis::device_code_objects())
    for (const auto& kernel : apsis::host_kernels()) {
      const std::string code(reinterpret_cast<const char*>(object.code), object.bytes);
      EXPECT_NE(code.find(kernel.name), std::string::npos) << object.processor << " " << kernel.name;
    }
}

}  // namespace lane_team_test
