// Sums over vectors do not depend on their order. They agree with permutations, threads, and exact sums.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>
#include <nvector/nvector_pthreads.h>
#include <sundials/support.hpp>
#include <support/property.hpp>

namespace sundials_sums_test {

namespace {

using namespace sundials_test;
using exact = boost::multiprecision::cpp_bin_float_100;

constexpr double rounding = std::numeric_limits<double>::epsilon() / 2;

/// Returns numbers of sizes from 2^−range to 2^range in pairs that nearly cancel.
std::vector<double> numbers_of_range(std::size_t n, int range, std::mt19937_64& random) {
  std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
  std::uniform_int_distribution<int> exponent(-range, range);
  std::vector<double> all(n);
  for (std::size_t i = 0; i < n; ++i)
    all[i] = i % 2 == 1 ? -all[i - 1] * (1.0 + 1e-9 * mantissa(random))
                        : std::ldexp(mantissa(random), exponent(random));
  return all;
}

double dot(const std::vector<double>& x, const std::vector<double>& y) {
  // SUNDIALS 6.4 calls the operation of the second vector.
  const auto first = owned(apsis_sundials_clone(serial(x).get())),
             second = owned(apsis_sundials_clone(serial(y).get()));
  return N_VDotProd(first.get(), second.get());
}

double dot_of_threads(const std::vector<double>& x, const std::vector<double>& y, int threads) {
  const auto n = static_cast<sunindextype>(x.size());
  std::vector<double> of_x = x, of_y = y;
  const auto first = owned(N_VMake_Pthreads(n, threads, of_x.data(), context()));
  const auto second = owned(N_VMake_Pthreads(n, threads, of_y.data(), context()));
  const auto copy = owned(apsis_sundials_clone(first.get())),
             other = owned(apsis_sundials_clone(second.get()));
  return N_VDotProd(copy.get(), other.get());
}

}  // namespace

TEST(sundials_sums, do_not_depend_on_order_or_threads_and_are_exact_to_rounding) {
  check_property("random numbers", [] {
    const auto seed = *rc::gen::arbitrary<unsigned>();
    std::mt19937_64 random(seed);
    const auto n = *rc::gen::inRange<std::size_t>(1, 600);
    const int range = *rc::gen::inRange(0, 200);
    const auto x = numbers_of_range(n, range, random), y = numbers_of_range(n, range / 2, random);
    const double sum = dot(x, y);

    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), random);
    std::vector<double> other_x, other_y;
    for (const auto i : order) {
      other_x.push_back(x[i]);
      other_y.push_back(y[i]);
    }
    RC_ASSERT(dot(other_x, other_y) == sum);
    for (const int threads : {1, 3}) RC_ASSERT(dot_of_threads(x, y, threads) == sum);

    // Each product is rounded. Parts below 2^−53 of the largest product are dropped. The sum of at most five
    // parts is rounded as often.
    exact truth = 0, size = 0, largest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const exact product = exact(x[i]) * exact(y[i]);
      truth += product;
      size += abs(product);
      largest = std::max(largest, exact(abs(product)));
    }
    RC_ASSERT(abs(exact(sum) - truth) <= rounding * size + rounding * largest + 5 * rounding * abs(truth));
  });
}

TEST(sundials_sums, differ_from_those_of_the_vector_itself) {
  // If the sums agreed, the tests above would prove nothing.
  std::mt19937_64 random(1);
  int different = 0;
  for (int k = 0; k < 50; ++k) {
    const auto x = numbers_of_range(500, 3, random), y = numbers_of_range(500, 0, random);
    different += N_VDotProd(serial(x).get(), serial(y).get()) != dot(x, y) ? 1 : 0;
  }
  EXPECT_GT(different, 25);
}

TEST(sundials_sums, keep_nan_infinity_and_the_ends_of_the_range) {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::nan("");
  EXPECT_TRUE(std::isnan(dot({1, nan, 2}, {1, 1, 1})));
  EXPECT_TRUE(std::isnan(dot({infinity, -infinity}, {1, 1})));
  EXPECT_EQ(dot({infinity, 1}, {1, 1}), infinity);
  EXPECT_EQ(dot({1e200, 1}, {1e200, 1}), infinity);
  for (const auto& order :
       std::vector<std::vector<double>>{{1.7e308, -1.7e308, 1e300}, {1e300, -1.7e308, 1.7e308}})
    EXPECT_EQ(dot(order, {1, 1, 1}), 1e300);
  EXPECT_EQ(dot({0, 0}, {1, 2}), 0.0);
  const double smallest = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(dot({smallest, smallest, smallest}, {1, 1, 1}), 3 * smallest);
}

TEST(sundials_sums, are_inherited_by_clones_and_norms) {
  const std::vector<double> x = {0x1p53, 1, -0x1p53, 3}, w = {2, 2, 2, 2};
  const auto copy = owned(apsis_sundials_clone(serial(x).get()));
  const auto again = owned(N_VClone(copy.get()));
  N_VScale(1.0, copy.get(), again.get());
  EXPECT_EQ(values(again.get()), x);
  EXPECT_EQ(N_VDotProd(serial({1, 1, 1, 1}).get(), again.get()), 4.0);
  EXPECT_EQ(N_VWL2Norm(again.get(), serial(w).get()), std::sqrt(0x1p109));
  EXPECT_EQ(N_VWrmsNorm(again.get(), serial(w).get()), std::sqrt(0x1p107));
  double several[2] = {0, 0};
  const auto ones = owned(N_VClone(copy.get()));
  N_VConst(1.0, ones.get());
  N_Vector all[] = {ones.get(), ones.get()};
  EXPECT_EQ(N_VDotProdMulti(2, again.get(), all, several), 0);
  EXPECT_EQ(several[0], 4.0);
  EXPECT_EQ(several[1], 4.0);
}

}  // namespace sundials_sums_test
