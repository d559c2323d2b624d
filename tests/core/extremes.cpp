#include <apsis/core/extremes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace apsis::extremes_test {
namespace {

const double nan = std::numeric_limits<double>::quiet_NaN();
const double infinity = std::numeric_limits<double>::infinity();

TEST(extremes, equal_std_max_and_min_without_nan) {
  for (const double a : {-infinity, -1.0, 0.0, 2.0, infinity})
    for (const double b : {-infinity, -3.0, 0.0, 2.0, infinity}) {
      EXPECT_EQ(maximum(a, b), std::max(a, b));
      EXPECT_EQ(minimum(a, b), std::min(a, b));
    }
}

TEST(extremes, propagate_nan_from_any_position) {
  for (const double x : {-infinity, 0.0, infinity, nan}) {
    EXPECT_TRUE(std::isnan(maximum(x, nan)) && std::isnan(maximum(nan, x)));
    EXPECT_TRUE(std::isnan(minimum(x, nan)) && std::isnan(minimum(nan, x)));
  }
  for (int at = 0; at < 3; ++at) {
    std::vector<double> values{1.0, 2.0, 3.0};
    values[static_cast<std::size_t>(at)] = nan;
    EXPECT_TRUE(std::isnan(maximum(values))) << at;
  }
}

TEST(extremes, maximum_of_a_list_is_its_largest_number) {
  EXPECT_EQ(maximum({-3.0, -1.0, -2.0}), -1.0);
  EXPECT_EQ(maximum(std::vector<double>{}), -infinity);
}

}  // namespace
}  // namespace apsis::extremes_test
