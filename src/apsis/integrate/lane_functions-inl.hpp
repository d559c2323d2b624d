#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

/// @cond
/// Elementary functions of eight numbers side by side. The component `integrate` needs no vector library, so
/// they are written here. Arguments are reduced by fractions of log 2 or π/2 of 33 bits, whose multiples are
/// exact (Cody, Waite, Software Manual for the Elementary Functions, 1980). Taylor series follow, whose
/// first omitted term is below 1e-17. Results are within three units in the last place. Outside the range of
/// a reduction every number goes to the standard library.
namespace apsis::lane_arithmetic::vectors {

inline constexpr std::size_t count = 8;
using numbers [[gnu::vector_size(count * sizeof(double))]] = double;
using integers [[gnu::vector_size(count * sizeof(double))]] = long long;

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__)
inline constexpr bool has_exact_sums = false;
#else
inline constexpr bool has_exact_sums = true;
#endif

/// y_k ← f(x_k) for a function of doubles. Results are arguments, because calls that return vectors have
/// another binary interface on every processor.
template <class F>
void one_by_one(const numbers& x, numbers& y, const F& f) {
  for (std::size_t k = 0; k < count; ++k) y[k] = f(x[k]);
}

/// Whether least ≤ x_k ≤ most for all k; false for NaN. False also with -ffast-math, which changes the order
/// of the sums of a reduction.
inline bool within(const numbers& x, double least, double most) {
  if (!has_exact_sums) return false;
  using bytes [[gnu::vector_size(count)]] = signed char;
  const integers inside = (x >= least) & (x <= most);
  const bytes narrow = __builtin_convertvector(inside, bytes);
  std::uint64_t all;
  std::memcpy(&all, &narrow, sizeof all);
  return all == ~std::uint64_t{0};
}

/// A number whose last bit counts units: sums with it round, and their bits count. Only AVX-512 has
/// conversions to integers of 64 bits.
inline constexpr double units = 0x1.8p52;
inline constexpr long long bits_of_units = 0x4338000000000000;

/// q ← x rounded to integers, k ← q. Requires |x| < 2^50.
inline void round(const numbers& x, numbers& q, integers& k) {
  const numbers sum = x + units;
  q = sum - units;
  std::memcpy(&k, &sum, sizeof k);
  k -= bits_of_units;
}

/// sum ← c₀ + x (c₁ + x (c₂ + …)).
template <std::size_t N>
void polynomial(const numbers& x, const double (&c)[N], numbers& sum) {
  sum = numbers{} + c[N - 1];
  for (std::size_t i = N - 1; i-- > 0;) sum = sum * x + c[i];
}

/// log 2 in two parts, the first of 33 bits.
inline constexpr double log2_head = 6.93147180369123816490e-01, log2_tail = 1.90821492927058770002e-10;

/// y ← e^x = 2^q e^r with |r| ≤ ½ log 2.
inline void exp(const numbers& x, numbers& y) {
  if (!within(x, -700.0, 700.0)) return one_by_one(x, y, [](double z) { return std::exp(z); });
  numbers q, power, series;
  integers k;
  round(x * 1.44269504088896340736, q, k);
  const numbers r = (x - q * log2_head) - q * log2_tail;
  static constexpr double inverse_factorials[] = {
      1.0 / 2,     1.0 / 6,      1.0 / 24,      1.0 / 120,      1.0 / 720,       1.0 / 5040,
      1.0 / 40320, 1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800};
  polynomial(r, inverse_factorials, series);
  const integers bits = (k + 1023) << 52;
  std::memcpy(&power, &bits, sizeof power);
  y = (1.0 + (r + r * r * series)) * power;
}

/// y ← log x = e log 2 + 2 artanh z with x = 2^e m, √½ ≤ m < √2, z = (m − 1)/(m + 1).
inline void log(const numbers& x, numbers& y) {
  if (!within(x, 1e-300, 1e300)) return one_by_one(x, y, [](double z) { return std::log(z); });
  integers bits;
  std::memcpy(&bits, &x, sizeof bits);
  // Numbers from √½ to √2 have e = 0.
  constexpr long long bits_of_root = 0x3FE6A09E667F3BCD;
  const integers e = (bits - bits_of_root) >> 52, bits_of_m = bits - (e << 52), counted = e + bits_of_units;
  numbers m, exponent, series;
  std::memcpy(&m, &bits_of_m, sizeof m);
  std::memcpy(&exponent, &counted, sizeof exponent);
  exponent -= units;
  const numbers f = m - 1.0, z = f / (m + 1.0), z2 = z * z;
  static constexpr double odd[] = {2.0 / 3,  2.0 / 5,  2.0 / 7,  2.0 / 9,  2.0 / 11,
                                   2.0 / 13, 2.0 / 15, 2.0 / 17, 2.0 / 19, 2.0 / 21};
  polynomial(z2, odd, series);
  // 2z = f − zf, where f is exact.
  y = exponent * log2_head + (f - (z * (f - z2 * series) - exponent * log2_tail));
}

/// y ← the sine of x + turns π/2. With q the multiple of π/2 nearest to x, |r| ≤ π/4 is the rest.
inline void sine(const numbers& x, long long turns, numbers& y) {
  numbers q, of_sine, of_cosine;
  integers k;
  round(x * 0.63661977236758134308, q, k);
  k += turns;
  const numbers r = ((x - q * 1.57079632673412561417e+00) - q * 6.07710050630396597660e-11) -
                    q * 2.02226624879595063154e-21;
  const numbers r2 = r * r;
  static constexpr double odd[] = {
      -1.0 / 6,        1.0 / 120,        -1.0 / 5040,          1.0 / 362880,
      -1.0 / 39916800, 1.0 / 6227020800, -1.0 / 1307674368000, 1.0 / 355687428096000};
  static constexpr double even[] = {1.0 / 24,        -1.0 / 720,         1.0 / 40320,         -1.0 / 3628800,
                                    1.0 / 479001600, -1.0 / 87178291200, 1.0 / 20922789888000};
  polynomial(r2, odd, of_sine);
  polynomial(r2, even, of_cosine);
  const numbers s = r + r * r2 * of_sine, c = 1.0 - (0.5 * r2 - r2 * r2 * of_cosine);
  y = (k & 1) != 0 ? c : s;
  y = (k & 2) != 0 ? -y : y;
}

/// Largest |x| of the reduction by π/2: multiples up to 2^20 are exact.
inline constexpr double largest_angle = 1e6;

inline void sin(const numbers& x, numbers& y) {
  if (within(x, -largest_angle, largest_angle)) return sine(x, 0, y);
  one_by_one(x, y, [](double z) { return std::sin(z); });
}
inline void cos(const numbers& x, numbers& y) {
  if (within(x, -largest_angle, largest_angle)) return sine(x, 1, y);
  one_by_one(x, y, [](double z) { return std::cos(z); });
}

}  // namespace apsis::lane_arithmetic::vectors
/// @endcond
