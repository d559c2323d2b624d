// Linear stability against formulas derived by hand from the Shu–Osher form, and against the exponential.
#include <apsis/method/stability.hpp>

#include "tableaux.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <support/property.hpp>

namespace apsis::test {
namespace {

using complex = std::complex<long double>;

butcher_form<long double> implicit_part(const std::string& name) {
  return to_butcher(find_method(name).coefficients<long double>());
}

/// Any point of the plane with 1e-3 ≤ |z| ≤ 1e3.
complex random_point(std::uint64_t seed) {
  noise draw(seed);
  return std::polar(std::pow(10.0L, 3.0L * static_cast<long double>(draw())),
                    std::numbers::pi_v<long double> * static_cast<long double>(draw()));
}

/// y = 1 + zy − z²y/2.
complex taylor(complex z) {
  return 1.0L / (1.0L - z + z * z / 2.0L);
}

/// y₁ = 1 − z²y₁/6, then y = y₁ + zy − z²y/3.
complex third_order(complex z) {
  return 1.0L / ((1.0L + z * z / 6.0L) * (1.0L - z + z * z / 3.0L));
}

complex trapezoidal(complex z) {
  return (1.0L + z / 2.0L) / (1.0L - z / 2.0L);
}

void expect_function(const std::string& name, complex (*wanted)(complex)) {
  const auto b = implicit_part(name);
  check_property(name + ": R(z) is the rational function worked out by hand", [&] {
    const complex z = random_point(*rc::gen::arbitrary<std::uint32_t>());
    const complex exact = wanted(z);
    // Rounding is enlarged near poles, by about |zR'/R| ≤ |z|² (1 + |R|), and by the coefficients (2⁻⁶⁴).
    const long double size = 1 + std::norm(z) * (1 + std::abs(exact));
    RC_ASSERT(std::abs(stability_function(b, z) - exact) <= 1e-17L * size * (1 + std::abs(exact)));
  });
}

TEST(stability, function_of_small_methods_is_the_rational_function_known) {
  expect_function("imdrk-1-2", taylor);
  expect_function("imdrk-2-3", third_order);
  expect_function("dirk-2-2", trapezoidal);
}

TEST(stability, function_approximates_the_exponential_to_the_order_of_the_method) {
  for (const auto& name : method_names()) {
    const method& m = find_method(name);
    if (m.kind == method_kind::explicit_only) continue;
    const auto b = implicit_part(name);
    for (const complex direction : {complex(-1, 0), complex(1, 0), complex(0, 1), complex(-0.6L, 0.8L)}) {
      const auto error = [&](long double h) {
        return std::abs(stability_function(b, h * direction) - std::exp(h * direction));
      };
      // h^{p+1} = 1e-12 is far above rounding, constants of 1e-4 included; the next power changes the slope
      // by O(h).
      const long double h = std::pow(1e-12L, 1.0L / (m.claims.order + 1));
      const long double slope = std::log2(error(2 * h) / error(h));
      EXPECT_NEAR(static_cast<double>(slope), m.claims.order + 1, 0.1) << name << direction;
    }
  }
}

TEST(stability, poles_of_the_third_order_method_lie_at_the_roots_of_minus_6) {
  const auto b = implicit_part("imdrk-2-3");
  const auto s = analyse_stability(b);
  ASSERT_EQ(s.imaginary_poles.size(), 1U);
  EXPECT_DOUBLE_EQ(s.imaginary_poles[0], std::sqrt(6.0));
  for (const long double sign : {-1.0L, 1.0L}) {
    // A simple pole: |R| is inverse to the distance.
    const auto near_pole = [&](long double distance) {
      return std::abs(stability_function(b, complex(0, sign * std::sqrt(6.0L) * (1 + distance))));
    };
    EXPECT_NEAR(static_cast<double>(near_pole(1e-7L) / near_pole(1e-6L)), 10.0, 1e-4);
    EXPECT_GT(near_pole(1e-7L), 1e5L);
  }
}

TEST(stability, every_method_of_the_paper_damps_stiff_modes_completely_and_without_sign_change) {
  for (const std::string name : {"imdrk-1-2", "imdrk-2-3", "imdrk-5-4", "md-imex-3-2", "md-imex-6-3"}) {
    const auto s = analyse_stability(implicit_part(name));
    // At z = −1e12 the last stage divides by 1e11 or more, and everything before it is bounded by 1.
    EXPECT_LT(s.at_infinity, 1e-10) << name;
    // Convex combinations of u^n and of stages divided by numbers ≥ 1: between 0 and 1 on the whole axis.
    EXPECT_GE(s.smallest_on_negative_axis, 0.0) << name;
    EXPECT_LE(s.largest_on_negative_axis, 1.0) << name;
  }
}

TEST(stability, comparators_do_not_damp_stiff_modes) {
  const auto trapezoid = analyse_stability(implicit_part("dirk-2-2"));
  EXPECT_NEAR(trapezoid.at_infinity, 1.0, 1e-10);
  EXPECT_NEAR(trapezoid.smallest_on_negative_axis, -1.0, 1e-7);  // R = −1 + 4/|z| at |z| = 1e8
  EXPECT_DOUBLE_EQ(trapezoid.angle, 90.0);
  // A y = 0 beyond y_1 = 1, row by row: y_2 = −1, y_3 = −804/855, y_4 = (71 − 125·804/855)/70.
  const auto four = analyse_stability(implicit_part("dirk-4-3"));
  EXPECT_NEAR(four.at_infinity, (125.0 * 804 / 855 - 71) / 70, 1e-10);
}

/// |R| ≤ 1 on the ray at `degrees` from the negative axis, with radii ten times as dense as the library's.
bool stable_ray(complex (*R)(complex), long double degrees) {
  for (int k = 0; k <= 4000; ++k) {
    const complex z = std::polar(std::pow(10.0L, -3.0L + k / 571.0L),
                                 std::numbers::pi_v<long double> * (1 - degrees / 180));
    if (std::abs(R(z)) > 1 + 1e-10L) return false;
  }
  return true;
}

TEST(stability, angle_is_that_of_a_finer_search) {
  EXPECT_DOUBLE_EQ(analyse_stability(implicit_part("imdrk-1-2")).angle, 90.0);
  EXPECT_TRUE(stable_ray(taylor, 90));
  const double angle = analyse_stability(implicit_part("imdrk-2-3")).angle;
  EXPECT_LT(angle, 90.0);  // the poles are on the imaginary axis
  EXPECT_GT(angle, 0.0);
  // The largest |R| on a ray is flat in the radius: samples 6 % apart move the angle by a few hundredths.
  EXPECT_TRUE(stable_ray(third_order, static_cast<long double>(angle) - 0.1L)) << angle;
  EXPECT_FALSE(stable_ray(third_order, static_cast<long double>(angle) + 0.1L)) << angle;
}

}  // namespace
}  // namespace apsis::test
