#include <apsis/core/exact_sum.hpp>

#include <cmath>
#include <limits>

namespace apsis {
namespace {

constexpr std::size_t nan_at = 68, plus_at = 69, minus_at = 70;

/// Returns Σ_k digits_k 2^(32k − 1074) for digits in [0, 2^32), rounded to nearest even.
double rounded(const std::int64_t* digits, std::size_t count) {
  std::size_t top = count;
  while (top > 0 && digits[top - 1] == 0) --top;
  if (top == 0) return 0.0;
  // Collects the 64 leading bits, and whether a nonzero bit follows them. These are more than the 53 bits of
  // the result, so that the result is rounded only once.
  std::uint64_t leading = 0;
  bool rest = false;
  int exponent = 0, missing = 64;
  for (std::size_t k = top; k-- > 0;) {
    const auto digit = static_cast<std::uint64_t>(digits[k]);
    int width = 32;
    if (k + 1 == top) width = static_cast<int>(std::bit_width(digit));
    if (missing >= width) {
      leading = width == 64 ? digit : (leading << static_cast<unsigned>(width)) | digit;
      missing -= width;
      exponent = 32 * static_cast<int>(k);
    } else if (missing > 0) {
      const auto dropped = static_cast<unsigned>(width - missing);
      leading = (leading << static_cast<unsigned>(missing)) | (digit >> dropped);
      rest = (digit & ((std::uint64_t{1} << dropped) - 1)) != 0;
      exponent = 32 * static_cast<int>(k) + static_cast<int>(dropped);
      missing = 0;
    } else {
      rest = rest || digit != 0;
    }
  }
  if (rest) leading |= 1U;
  // A result below 2^-1022 has at most 52 bits and needs no rounding.
  return std::ldexp(static_cast<double>(leading), exponent - 1074);
}

}  // namespace

void exact_sum::add_special(double x) {
  ++words_[std::isnan(x) ? nan_at : x > 0.0 ? plus_at : minus_at];
}

void exact_sum::add(const exact_sum& other) {
  carry();
  exact_sum all = other;
  all.carry();
  for (std::size_t k = 0; k < length; ++k) words_[k] += all.words_[k];
  carry();
}

void exact_sum::carry() {
  for (std::size_t k = 0; k + 1 < digits; ++k) {
    const std::int64_t over = words_[k] >> 32U;  // rounds down, which leaves a digit ≥ 0
    words_[k] -= over * (std::int64_t{1} << 32U);
    words_[k + 1] += over;
  }
  terms_ = 0;
}

std::span<std::int64_t, exact_sum::length> exact_sum::words() {
  carry();
  return words_;
}

double exact_sum::value() const {
  exact_sum all = *this;
  all.carry();
  if (words_[nan_at] > 0 || (words_[plus_at] > 0 && words_[minus_at] > 0))
    return std::numeric_limits<double>::quiet_NaN();
  if (words_[plus_at] > 0) return std::numeric_limits<double>::infinity();
  if (words_[minus_at] > 0) return -std::numeric_limits<double>::infinity();
  // All digits but the last are nonnegative, so that the last one determines the sign of the sum.
  if (all.words_[digits - 1] >= 0) return rounded(all.words_.data(), digits);
  for (std::size_t k = 0; k < digits; ++k) all.words_[k] = -all.words_[k];
  all.carry();
  return -rounded(all.words_.data(), digits);
}

}  // namespace apsis
