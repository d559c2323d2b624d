#include <apsis/scheme/limiter.hpp>

#include <cmath>

#include <gtest/gtest.h>
#include <support/property.hpp>

namespace limiter_test {

namespace {
/// Returns a nonnegative number of any magnitude, possibly zero.
double any_average() {
  return *rc::gen::element(0.0, 1.0, 2.3) * std::pow(10.0, *rc::gen::inRange(-300, 30));
}
double any_edge(double scale) {
  return (*rc::gen::inRange(-4000, 4001)) * 1e-3 * scale;
}
}  // namespace

TEST(limiter, makes_edge_and_interior_values_nonnegative) {
  check_property("nonnegative", [] {
    const double c = any_average();
    double l = any_edge(c), r = any_edge(c);
    apsis::limiter::apply(&c, 1, &l, &r);
    RC_ASSERT(l >= 0.0);
    RC_ASSERT(r >= 0.0);
    RC_ASSERT(apsis::limiter::interior(c, l, r) >= 0.0);
    RC_ASSERT(std::isfinite(l + r));
  });
}

TEST(limiter, keeps_a_forward_euler_step_at_its_limit_nonnegative_in_floating_point) {
  // The step is c − κ(out − in) with κ = 1/12 and in ≥ 0, for any rounding of the sum.
  check_property("update", [] {
    const double c = any_average();
    double l = any_edge(c), r = any_edge(c);
    apsis::limiter::apply(&c, 1, &l, &r);
    for (const double out : {l, r}) RC_ASSERT(c + (1.0 / 12.0) * (0.0 - out) >= 0.0);
  });
}

TEST(limiter, does_not_change_admissible_edges) {
  const double c = 1.0;
  double l = 0.8, r = 1.3;
  apsis::limiter::apply(&c, 1, &l, &r);
  EXPECT_EQ(l, 0.8);
  EXPECT_EQ(r, 1.3);
}

TEST(limiter, flattens_empty_and_negative_cells) {
  for (const double c : {0.0, -1.0}) {
    double l = -0.5, r = 0.25;
    apsis::limiter::apply(&c, 1, &l, &r);
    EXPECT_EQ(l, c);
    EXPECT_EQ(r, c);
  }
}

}  // namespace limiter_test
