#include <apsis/study/order_map.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace apsis::order_map_test {
namespace {

/// Returns errors composed of Δt², a plateau 0.1 ε, and the uncertainty of the reference.
order_map made() {
  order_map m{"none", "none", 2, {1e-12, 1e-4}, {}, {}};
  for (int k = 2; k <= 20; ++k) m.dt.push_back(std::ldexp(1.0, -k));
  for (const double epsilon : m.epsilon) {
    m.error.emplace_back();
    for (const double dt : m.dt) m.error.back().push_back(dt * dt + 0.1 * epsilon);
  }
  return m;
}

TEST(order_map, distinguishes_order_plateau_and_uncertainty_of_the_reference) {
  const auto m = made();
  EXPECT_EQ(m.kind(0, 0), order_class::design);
  EXPECT_NEAR(m.slope(0, 0), 2, 1e-9);
  EXPECT_EQ(m.kind(1, 0), order_class::design);
  EXPECT_EQ(m.kind(1, m.dt.size() - 2), order_class::plateau);
  EXPECT_EQ(m.kind(1, 6), order_class::reduced);  // Δt² = 1.5e-5, then 3.8e-6, in addition to 1e-5
  EXPECT_EQ(m.kind(0, m.dt.size() - 2), order_class::unknown);
  EXPECT_TRUE(std::isnan(m.slope(0, m.dt.size() - 2)));
  EXPECT_LT(m.smallest_slope(), 0.01);
}

TEST(order_map, slopes_exclude_other_error_terms) {
  const auto m = made();
  EXPECT_NEAR(m.fine_slope(0), 2, 0.02);         // above the limit of the reference
  EXPECT_LT(m.fine_slope(1), 0.01);              // on the plateau
  EXPECT_NEAR(m.coarse_slope(1, 1e-3), 2, 0.1);  // above it
  EXPECT_TRUE(std::isnan(m.coarse_slope(1, 1.0)));
}

TEST(order_map, becomes_a_map_of_slopes) {
  const auto m = made();
  const auto p = m.map();
  ASSERT_EQ(p.maps.size(), 1U);
  EXPECT_EQ(p.maps[0].x.size(), m.dt.size() - 1);
  EXPECT_EQ(p.maps[0].y, m.epsilon);
  EXPECT_EQ(p.maps[0].value[1][3], m.slope(1, 3));
}

}  // namespace
}  // namespace apsis::order_map_test
