#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <rapidcheck.h>

/// Random numbers in a property. They shrink towards `low`.
namespace random_input {

/// Returns an integer in [low, high), always drawn from the whole range. RapidCheck itself starts
/// with small ones.
inline int integer(int low, int high) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(low, high));
}

inline bool one_in(int n) {
  return integer(0, n) == 0;
}

inline double uniform(double low, double high) {
  return low + (high - low) * (integer(0, 1000001) * 1e-6);
}

/// Returns 10^x with x uniform in [low, high).
inline double magnitude(double low, double high) {
  return std::pow(10.0, uniform(low, high));
}

/// Returns n numbers ≥ 0 over thirteen orders of magnitude, about a quarter of them exactly zero.
inline std::vector<double> nonnegative(std::size_t n) {
  std::vector<double> u(n);
  for (double& x : u) x = one_in(4) ? 0.0 : magnitude(-12, 1);
  return u;
}

}  // namespace random_input
