#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace apsis {

/// A sum of doubles without rounding. It adds the terms, integer multiples of 2^-1074, in a fixed-point
/// number that spans all exponents. The result therefore depends neither on the order of the terms nor on
/// their distribution among threads and processes. Source: Neal, Fast exact summation using small and
/// large superaccumulators, 2015.
class exact_sum {
 public:
  /// Number of words of a sum.
  static constexpr std::size_t length = 71;

  /// Adds a term.
  void add(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const auto exponent = static_cast<unsigned>(bits >> 52U) & 0x7ffU;
    if (exponent == 0x7ffU) return add_special(x);
    const std::uint64_t fraction = bits & ((std::uint64_t{1} << 52U) - 1);
    // In units of 2^-1074 the term is mantissa · 2^shift.
    const std::uint64_t mantissa = exponent == 0 ? fraction : fraction | (std::uint64_t{1} << 52U);
    const unsigned power = exponent == 0 ? 0 : exponent - 1, word = power / 32, shift = power % 32;
    const auto low = static_cast<std::int64_t>((mantissa << shift) & 0xffffffffU),
               high = static_cast<std::int64_t>(mantissa >> (32 - shift));
    if ((bits >> 63U) == 0) {
      words_[word] += low;
      words_[word + 1] += high;
    } else {
      words_[word] -= low;
      words_[word + 1] -= high;
    }
    if (++terms_ == most_terms) carry();
  }
  /// Adds the terms of another sum.
  void add(const exact_sum& other);

  /// Returns the sum, rounded once to nearest. The value is NaN if a term is NaN or if the terms include both
  /// infinities. It is ±∞ if the terms include one infinity or the sum exceeds the largest number.
  double value() const;

  /// Returns the words of the sum. The elementwise sums of the words of several exact sums, at most 2^31, are
  /// the words of their total.
  std::span<std::int64_t, length> words();

 private:
  // A word has room for 32 bits and the carries of this many additions of mantissas below 2^53.
  static constexpr int most_terms = 1000;
  static constexpr std::size_t digits = 68;  // of 32 bits; the counts of NaN, +∞ and −∞ follow

  void add_special(double x);
  void carry();

  std::array<std::int64_t, length> words_{};
  int terms_ = 0;
};

}  // namespace apsis
