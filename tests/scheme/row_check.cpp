#include <apsis/scheme/row_check.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <support/instruction_sets.hpp>

namespace row_check_test {

TEST(row_check, finds_minimum_negative_entries_and_nan_at_any_position) {
  const double infinity = std::numeric_limits<double>::infinity(),
               nan = std::numeric_limits<double>::quiet_NaN();
  for_each_instruction_set([&] {
    for (const int n : {1, 2, 7, 8, 9, 31, 152})
      for (int at = 0; at < n; ++at) {
        std::vector<double> row(static_cast<std::size_t>(n), 3.0);
        double& value = row[static_cast<std::size_t>(at)];
        for (const double x : {-1e-300, 0.0, -0.0, 1.0, -5.0}) {
          value = x;
          const auto found = apsis::compute_extremes(row.data(), n);
          EXPECT_EQ(found.lowest, x);
          EXPECT_EQ(found.negative, x < 0.0 ? 1 : 0);
        }
        for (const double x : {infinity, -infinity, nan}) {
          value = x;
          EXPECT_TRUE(std::isnan(apsis::compute_extremes(row.data(), n).lowest)) << n << " " << at;
        }
      }
  });
}

}  // namespace row_check_test
