// Linear stability agrees with formulas derived by hand from the Shu–Osher form, and with
// the exponential function.
#include <apsis/method/stability.hpp>

#include "tableaux.hpp"

#include <apsis/method/certificate.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <support/property.hpp>

namespace apsis::test::stability_test {
namespace {

using complex = std::complex<long double>;

butcher_form<long double> implicit_part(const std::string& name) {
  return to_butcher(find_method(name).coefficients<long double>());
}

/// Returns a random point of the plane with 1e-3 ≤ |z| ≤ 1e3.
complex random_point(std::uint64_t seed) {
  noise draw(seed);
  return std::polar(std::pow(10.0L, 3.0L * static_cast<long double>(draw())),
                    std::numbers::pi_v<long double> * static_cast<long double>(draw()));
}

/// Returns the solution of y = 1 + zy − z²y/2.
complex taylor(complex z) {
  return 1.0L / (1.0L - z + z * z / 2.0L);
}

/// Returns the solution of y₁ = 1 − z²y₁/6, then y = y₁ + zy − z²y/3.
complex third_order(complex z) {
  return 1.0L / ((1.0L + z * z / 6.0L) * (1.0L - z + z * z / 3.0L));
}

complex trapezoidal(complex z) {
  return (1.0L + z / 2.0L) / (1.0L - z / 2.0L);
}

void expect_function(const std::string& name, complex (*wanted)(complex)) {
  const auto b = implicit_part(name);
  check_property(name + ": R(z) is the rational function derived by hand", [&] {
    const complex z = random_point(*rc::gen::arbitrary<std::uint32_t>());
    const complex exact = wanted(z);
    // Rounding errors grow near poles by about |zR'/R| ≤ |z|² (1 + |R|). The coefficients have rounding
    // errors of 2⁻⁶⁴.
    const long double size = 1 + std::norm(z) * (1 + std::abs(exact));
    RC_ASSERT(std::abs(stability_function(b, z) - exact) <= 1e-17L * size * (1 + std::abs(exact)));
  });
}

TEST(stability, function_of_small_methods_is_the_known_rational_function) {
  expect_function("imdrk-1-2", taylor);
  expect_function("imdrk-2-3", third_order);
  expect_function("dirk-2-2", trapezoidal);
}

TEST(stability, function_approximates_the_exponential_to_the_order_of_the_method) {
  for (const auto& name : method_names()) {
    const method& m = find_method(name);
    if (!has_derivatives(m.kind)) continue;  // no implicit part
    const auto b = implicit_part(name);
    for (const complex direction : {complex(-1, 0), complex(1, 0), complex(0, 1), complex(-0.6L, 0.8L)}) {
      const auto error = [&](long double h) {
        return std::abs(stability_function(b, h * direction) - std::exp(h * direction));
      };
      // h^{p+1} = 1e-12 is far above rounding, even with constants of 1e-4. The next power changes the ratio
      // by O(h).
      const long double h = std::pow(1e-12L, 1.0L / (m.claims.order + 1));
      const long double slope = std::log2(error(2 * h) / error(h));
      EXPECT_NEAR(static_cast<double>(slope), m.claims.order + 1, 0.1) << name << direction;
    }
  }
}

TEST(stability, poles_of_the_third_order_method_lie_at_the_roots_of_minus_6) {
  const auto b = implicit_part("imdrk-2-3");
  const auto& s = find_certificate("imdrk-2-3").stability;
  ASSERT_EQ(s.imaginary_poles.size(), 1U);
  EXPECT_DOUBLE_EQ(s.imaginary_poles[0], std::sqrt(6.0));
  for (const long double sign : {-1.0L, 1.0L}) {
    // Near a simple pole |R| is inversely proportional to the distance.
    const auto near_pole = [&](long double distance) {
      return std::abs(stability_function(b, complex(0, sign * std::sqrt(6.0L) * (1 + distance))));
    };
    EXPECT_NEAR(static_cast<double>(near_pole(1e-7L) / near_pole(1e-6L)), 10.0, 1e-4);
    EXPECT_GT(near_pole(1e-7L), 1e5L);
  }
}

TEST(stability, of_the_papers_methods_is_complete_damping_without_sign_change) {
  for (const std::string name : {"imdrk-1-2", "imdrk-2-3", "imdrk-5-4", "md-imex-3-2", "md-imex-6-3"}) {
    const auto& s = find_certificate(name).stability;
    // At z = −1e12 the last stage divides by 1e11 or more. All earlier stages are bounded by 1.
    EXPECT_LT(s.at_infinity, 1e-10) << name;
    // Stages are convex combinations of u^n and of stages divided by numbers ≥ 1. They are thus between 0 and
    // 1 on the whole axis.
    EXPECT_GE(s.smallest_on_negative_axis, 0.0) << name;
    EXPECT_LE(s.largest_on_negative_axis, 1.0) << name;
  }
}

TEST(stability, comparators_do_not_damp_stiff_modes) {
  const auto& trapezoid = find_certificate("dirk-2-2").stability;
  EXPECT_NEAR(trapezoid.at_infinity, 1.0, 1e-10);
  EXPECT_NEAR(trapezoid.smallest_on_negative_axis, -1.0, 1e-7);  // R = −1 + 4/|z| at |z| = 1e8
  EXPECT_DOUBLE_EQ(trapezoid.angle, 90.0);
  // A y = 0 beyond y_1 = 1 gives row by row y_2 = −1, y_3 = −804/855, y_4 = (71 − 125·804/855)/70.
  const auto& four = find_certificate("dirk-4-3").stability;
  EXPECT_NEAR(four.at_infinity, (125.0 * 804 / 855 - 71) / 70, 1e-10);
}

/// Returns the largest |R| on the ray at `degrees` from the negative axis, by forward substitution in the
/// Butcher form. It samples 500 radii per decade, and 200 more on both sides of each local maximum.
long double largest_on_ray(const butcher_form<long double>& b, long double degrees) {
  const long double radians = degrees * std::numbers::pi_v<long double> / 180;
  const auto size = [&](long double decade) {
    const long double radius = std::pow(10.0L, decade);
    return std::abs(stability_function(b, complex(-radius * std::cos(radians), -radius * std::sin(radians))));
  };
  constexpr int per_decade = 500, finer = 200;
  std::vector<long double> values;
  for (int k = -3 * per_decade; k <= 4 * per_decade; ++k)
    values.push_back(size(static_cast<long double>(k) / per_decade));
  long double largest = std::max(values.front(), values.back());
  for (std::size_t k = 1; k + 1 < values.size(); ++k) {
    if (values[k] < values[k - 1] || values[k] < values[k + 1] || values[k] < 0.99L) continue;
    for (int l = -finer; l <= finer; ++l)
      largest = std::max(
          largest,
          size(-3 + (static_cast<long double>(k) + static_cast<long double>(l) / finer) / per_decade));
  }
  return largest;
}

std::vector<std::string> methods_and_members() {
  auto names = method_names();
  for (const int stages : {3, 4, 7, 12, 20, 40, 64}) {
    names.push_back("md-imex-chain-" + std::to_string(stages) + "-2");
    if (stages >= 5) names.push_back("md-imex-plateau-free-" + std::to_string(stages) + "-2");
  }
  return names;
}

TEST(stability, angle_of_every_method_is_a_sharp_lower_bound) {
  for (const auto& name : methods_and_members()) {
    if (!has_derivatives(find_method(name).kind)) continue;
    const double angle = find_certificate(name).stability.angle;
    const auto b = implicit_part(name);
    // Poles at 60 to 90 degrees amplify rounding errors (10⁻¹⁹) by a few thousand. Long chains of stages
    // accumulate them.
    EXPECT_LE(largest_on_ray(b, static_cast<long double>(angle)), 1 + 1e-13L) << name << " " << angle;
    if (angle == 90.0) continue;
    // Smaller angles are stable too. Angles larger by 0.001 degrees are not.
    EXPECT_LE(largest_on_ray(b, 0.9L * static_cast<long double>(angle)), 1 + 1e-13L) << name << " " << angle;
    EXPECT_GT(largest_on_ray(b, static_cast<long double>(angle) + 1e-3L), 1.0L) << name << " " << angle;
  }
}

TEST(stability, angles_agree_with_an_independent_computation) {
  // The expected angles are from maxima of |R| of polynomials in 60 digits, with the digits given.
  EXPECT_NEAR(find_certificate("md-imex-14-4-accurate").stability.angle, 84.249, 6e-4);
  EXPECT_EQ(find_certificate("imdrk-1-2").stability.angle, 90.0);
}

/// Returns the one-stage form u = 1 + zu d + z²u ḋ.
shu_osher_form<long double> one_stage(long double d, long double ddot) {
  shu_osher_form<long double> m;
  m.P = m.W = m.D = matrix<long double>(1, 1);
  m.D(0, 0) = d;
  m.ddot = {ddot};
  m.r = 1;
  return m;
}

TEST(stability, of_one_stage_follows_from_its_denominator) {
  // |1 − iyd + y²ḋ|² − 1 = y²(d² + 2ḋ) + y⁴ḋ² is nonnegative for all y if and only if d² ≥ −2ḋ.
  EXPECT_EQ(analyse_stability(one_stage(1, -0.5L)).angle, 90.0);
  EXPECT_EQ(analyse_stability(one_stage(1, 0)).angle, 90.0);
  EXPECT_LT(analyse_stability(one_stage(1, -0.5001L)).angle, 90.0);
  // For d = 0, |1 + r² e^{-2iα}|² = 1 + 2r² cos 2α + r⁴ is below 1 for small r if α > 45 degrees. This R does
  // not approximate exp(z). |R| is flat near 0, where a proof loses some 10⁻⁴ degrees.
  EXPECT_NEAR(analyse_stability(one_stage(0, -1)).angle, 45.0, 1e-3);
  EXPECT_LE(analyse_stability(one_stage(0, -1)).angle, 45.0);
  // Poles lie on the negative axis, or left of the imaginary axis: 1 + z + z² = 0 at 120 degrees from the
  // positive axis.
  EXPECT_EQ(analyse_stability(one_stage(-1, 0)).angle, 0.0);
  EXPECT_LE(analyse_stability(one_stage(-1, -1)).angle, 60.0);
  EXPECT_EQ(analyse_stability(one_stage(0, 1)).angle, 0.0);
}

}  // namespace
}  // namespace apsis::test::stability_test
