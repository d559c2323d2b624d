#include <apsis/core/exact_sum.hpp>

#include <apsis/core/random_source.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

namespace exact_sum_test {

namespace {

using apsis::exact_sum;
using boost::multiprecision::cpp_int;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Returns x · 2^1074.
cpp_int scaled(double x) {
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);
  const cpp_int mantissa = static_cast<std::int64_t>(std::ldexp(fraction, 53));
  const int shift = exponent - 53 + 1074;
  return shift >= 0 ? cpp_int(mantissa << static_cast<unsigned>(shift))
                    : cpp_int(mantissa >> static_cast<unsigned>(-shift));
}

double sum_of(const std::vector<double>& terms) {
  exact_sum sum;
  for (const double x : terms) sum.add(x);
  return sum.value();
}

std::vector<double> random_terms(apsis::random_source& random, int count, double exponents) {
  std::vector<double> terms;
  for (int k = 0; k < count; ++k)
    terms.push_back(
        std::ldexp(random.uniform(-1.0, 1.0), static_cast<int>(random.uniform(-exponents, exponents))));
  return terms;
}

/// Returns true if x is the double nearest to `exact`, in units of 2^-1074. If two doubles are equally near,
/// x must be the even one.
bool is_nearest(double x, const cpp_int& exact) {
  const cpp_int off = abs(scaled(x) - exact);
  for (const double other : {std::nextafter(x, infinity), std::nextafter(x, -infinity)}) {
    const cpp_int distance = abs(scaled(other) - exact);
    if (distance < off ||
        (distance == off && off != 0 &&
         std::fmod(std::abs(x) / (std::nextafter(std::abs(x), infinity) - std::abs(x)), 2.0) != 0.0))
      return false;
  }
  return true;
}

}  // namespace

TEST(exact_sum, is_the_sum_of_integers_rounded_once) {
  apsis::random_source random(1);
  for (const double exponents : {2.0, 60.0, 1020.0})
    for (int repetition = 0; repetition < 50; ++repetition) {
      const auto terms = random_terms(random, 1 + repetition * 60, exponents);
      cpp_int exact = 0;
      for (const double x : terms) exact += scaled(x);
      EXPECT_TRUE(is_nearest(sum_of(terms), exact)) << exponents << " " << repetition;
    }
}

TEST(exact_sum, does_not_depend_on_order_or_partition) {
  apsis::random_source random(2);
  auto terms = random_terms(random, 5000, 1000.0);
  const double whole = sum_of(terms);
  for (int parts : {2, 3, 7}) {
    std::reverse(terms.begin(), terms.begin() + 1234 * parts % 4000);
    std::vector<exact_sum> each(static_cast<std::size_t>(parts));
    for (std::size_t k = 0; k < terms.size(); ++k) each[k * k % each.size()].add(terms[k]);
    exact_sum all;
    for (const auto& one : each) all.add(one);
    EXPECT_EQ(all.value(), whole) << parts;
    // Processes add their words.
    exact_sum reduced;
    const auto to = reduced.words();
    for (auto& one : each) {
      const auto words = one.words();
      for (std::size_t k = 0; k < words.size(); ++k) to[k] += words[k];
    }
    EXPECT_EQ(reduced.value(), whole) << parts;
  }
}

TEST(exact_sum, cancels_without_a_remainder) {
  EXPECT_EQ(sum_of({1e308, 1.0, -1e308, 5e-324, -1.0}), 5e-324);
  EXPECT_EQ(sum_of({1e16, 1.0, -1e16}), 1.0);
  EXPECT_EQ(sum_of({-1e300, 1e-300, 1e300, -1e-300}), 0.0);
  EXPECT_EQ(sum_of({}), 0.0);
  EXPECT_EQ(sum_of({-0.0, -3.0, 1.0}), -2.0);
}

TEST(exact_sum, rounds_ties_to_even) {
  const double half = std::ldexp(1.0, -53);
  EXPECT_EQ(sum_of({1.0, half}), 1.0);
  EXPECT_EQ(sum_of({1.0, half, 5e-324}), 1.0 + 2.0 * half);
  EXPECT_EQ(sum_of({1.0 + 2.0 * half, half}), 1.0 + 4.0 * half);
  EXPECT_EQ(sum_of({-1.0, -half, -5e-324}), -1.0 - 2.0 * half);
}

TEST(exact_sum, overflows_only_if_the_sum_does) {
  const double most = std::numeric_limits<double>::max();
  EXPECT_EQ(sum_of({most, most, -most}), most);
  EXPECT_EQ(sum_of({most, most}), infinity);
  EXPECT_EQ(sum_of({-most, -most}), -infinity);
  std::vector<double> many(100'000, most);
  many.resize(200'000, -most);
  EXPECT_EQ(sum_of(many), 0.0);
}

TEST(exact_sum, of_special_values_is_that_of_real_arithmetic) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(sum_of({1.0, infinity, 2.0}), infinity);
  EXPECT_EQ(sum_of({1.0, -infinity}), -infinity);
  EXPECT_TRUE(std::isnan(sum_of({infinity, -infinity})));
  EXPECT_TRUE(std::isnan(sum_of({1.0, nan, infinity})));
}

}  // namespace exact_sum_test
