// The quartic through a cell: its conditions, and its average by Gauss points.
#include <apsis/scheme/quartic.hpp>

#include <cmath>

#include <gtest/gtest.h>
#include <support/property.hpp>

namespace quartic_test {

TEST(quartic, meets_its_five_conditions_and_gauss_integrates_it) {
  check_property("conditions", [] {
    const auto number = [] { return *rc::gen::inRange(-1000, 1000) * 1e-3; };
    const double m = number(), c = number(), p = number(), l = number(), r = number();
    const apsis::quartic q(m, c, p, l, r);
    // The antiderivative gives averages over [a, a+1].
    const auto average = [&q](double a) {
      const auto primitive = [&q](double x) {
        return x * (q.c + q.d0 + x * (q.d1 / 2 + x * (q.d2 / 3 + x * (q.d3 / 4 + x * q.d4 / 5))));
      };
      return primitive(a + 1.0) - primitive(a);
    };
    const double rounding = 1e-13;  // about 20 operations with coefficients up to 10
    RC_ASSERT(std::abs(q(-0.5) - l) < rounding);
    RC_ASSERT(std::abs(q(0.5) - r) < rounding);
    RC_ASSERT(std::abs(average(-1.5) - m) < rounding);
    RC_ASSERT(std::abs(average(-0.5) - c) < rounding);
    RC_ASSERT(std::abs(average(0.5) - p) < rounding);
    double gauss = 0.0;
    for (std::size_t k = 0; k < 3; ++k) gauss += apsis::gauss3::weight[k] * q(apsis::gauss3::xi[k]);
    RC_ASSERT(std::abs(gauss - c) < rounding);
  });
}

}  // namespace quartic_test
