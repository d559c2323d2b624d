#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace apsis {

/// Random numbers for experiments. Unlike the distributions of the standard library, they are reproducible
/// on every platform.
class random_source {
 public:
  /// Seeds the 64-bit Mersenne twister; equal seeds give equal sequences.
  explicit random_source(std::uint64_t seed) : engine_(seed) {}

  /// Returns a number uniform in [low, high).
  double uniform(double low = 0.0, double high = 1.0) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  /// Returns 10^x with x uniform in [low, high).
  double magnitude(double low, double high) { return std::pow(10.0, uniform(low, high)); }
  /// Returns an integer uniform in [low, high).
  int integer(int low, int high) { return low + static_cast<int>(uniform() * (high - low)); }
  /// Returns true with probability 1/n, n ≥ 1.
  bool one_in(int n) { return integer(0, n) == 0; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace apsis
