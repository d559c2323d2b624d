// A history with a bounded number of rows keeps the first, last and extreme rows of the run.
#include <apsis/output/history.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace history_test {

using apsis::history;
using row = std::vector<double>;

namespace {

const std::vector<std::string> columns = {"step", "walk", "noise", "falling", "never"};

/// Returns rows with columns of different kinds: a random walk, a jump, a monotone decrease, NaN.
std::vector<row> some_rows(long steps) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::vector<row> rows;
  double walk = 0.0;
  for (long step = 0; step <= steps; ++step) {
    walk += any(random);
    rows.push_back({static_cast<double>(step), walk, any(random), -static_cast<double>(step),
                    std::numeric_limits<double>::quiet_NaN()});
  }
  return rows;
}

bool same(const row& a, const row& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

}  // namespace

TEST(a_history, keeps_the_first_the_last_and_the_extreme_rows_in_a_bounded_number) {
  const auto all = some_rows(20000);
  history kept(columns, 100);
  for (std::size_t n = 0; n < all.size(); ++n) {
    kept.add(all[n]);
    const auto& rows = kept.rows().rows;
    ASSERT_LE(rows.size(), 100U);
    ASSERT_TRUE(same(rows.front(), all[0]) && same(rows.back(), all[n]));
    if (n % 97 != 0 && n + 1 != all.size()) continue;
    for (std::size_t column = 1; column < 4; ++column) {
      const auto less = [column](const row& a, const row& b) { return a[column] < b[column]; };
      const auto upto = all.begin() + static_cast<std::ptrdiff_t>(n) + 1;
      EXPECT_TRUE(same(*std::min_element(all.begin(), upto, less),
                       *std::min_element(rows.begin(), rows.end(), less)));
      EXPECT_TRUE(same(*std::max_element(all.begin(), upto, less),
                       *std::max_element(rows.begin(), rows.end(), less)));
    }
  }
  // Between 50 and 100 rows have regular steps: 20000/256 = 78.
  EXPECT_EQ(kept.stride(), 256);
  for (const auto& one : kept.rows().rows) EXPECT_TRUE(same(one, all[static_cast<std::size_t>(one[0])]));
}

TEST(a_history, continued_from_any_row_has_the_same_rows) {
  const auto all = some_rows(3000);
  history whole(columns, 100);
  for (const auto& one : all) whole.add(one);
  for (const std::size_t at : {std::size_t{1}, std::size_t{99}, std::size_t{100}, std::size_t{1234}}) {
    history first(columns, 100);
    for (std::size_t n = 0; n < at; ++n) first.add(all[n]);
    history second(first.rows(), first.stride(), 100);
    for (std::size_t n = at; n < all.size(); ++n) second.add(all[n]);
    ASSERT_EQ(second.rows().rows.size(), whole.rows().rows.size()) << at;
    for (std::size_t n = 0; n < whole.rows().rows.size(); ++n)
      EXPECT_TRUE(same(whole.rows().rows[n], second.rows().rows[n])) << at;
  }
}

}  // namespace history_test
