// The limit of a case bounds the history of its run.
#include <apsis/config/case.hpp>
#include <apsis/run/session.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace run_history_test {

namespace {

/// Compares two rows. A column without a quantity in this run is NaN.
bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

}  // namespace

TEST(a_history, of_a_run_respects_the_limit_of_the_case) {
  const auto rows = [](const std::string& most) {
    apsis::run_session session(
        apsis::load_case("paper/ode", {"time.dt=1/4000", "time.end=1", "output.history_rows=" + most}), {});
    session.run();
    return session.records().history().rows;
  };
  const auto all = rows("100000"), some = rows("100");
  EXPECT_EQ(all.size(), 4001U);
  EXPECT_LE(some.size(), 100U);
  EXPECT_GE(some.size(), 50U);
  for (const auto& one : some) EXPECT_TRUE(same(one, all[static_cast<std::size_t>(one[0])]));
}

}  // namespace run_history_test
