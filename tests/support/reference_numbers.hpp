#pragma once

#include <apsis/core/random_source.hpp>
#include <apsis/exec/instruction_set.hpp>
#include <apsis/exec/number.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support/instruction_sets.hpp>

/// A number of exec/number.hpp whose fma rounds twice, as on instruction sets without fused operations.
struct unfused {
  double v;
  unfused(double from) : v(from) {}

  friend unfused operator+(unfused a, unfused b) { return a.v + b.v; }
  friend unfused operator-(unfused a, unfused b) { return a.v - b.v; }
  friend unfused operator*(unfused a, unfused b) { return a.v * b.v; }
  friend unfused operator/(unfused a, unfused b) { return a.v / b.v; }
  friend unfused operator-(unfused a) { return -a.v; }
  friend bool operator<(unfused a, unfused b) { return a.v < b.v; }
  friend bool operator>(unfused a, unfused b) { return a.v > b.v; }
  friend unfused fma(unfused a, unfused b, unfused c) {
    const volatile double product = a.v * b.v;  // a compiler with other flags must not fuse it
    return product + c.v;
  }
  friend unfused negative_fma(unfused a, unfused b, unfused c) {
    const volatile double product = a.v * b.v;
    return c.v - product;
  }
  friend unfused absolute(unfused a) { return std::abs(a.v); }
  friend unfused inverse_power_of_two(unfused a) { return apsis::scalar::inverse_power_of_two(a.v); }
  friend unfused truncated(unfused a) { return apsis::scalar::truncated(a.v); }
  friend unfused power_of_two(unfused a) { return apsis::scalar::power_of_two(a.v); }
  friend unfused exponent_near_one(unfused a) { return apsis::scalar::exponent_near_one(a.v); }
  friend unfused scaled_near_one(unfused a) { return apsis::scalar::scaled_near_one(a.v); }
};

inline double value_of(double x) {
  return x;
}
inline double value_of(unfused x) {
  return x.v;
}

/// Calls body(N, lanes) for every instruction set. Formulas on single numbers N have the bits of its packs of
/// `lanes` numbers.
template <class Body>
void for_each_number(const Body& body) {
  for_each_instruction_set([&body] {
    const std::string name = apsis::kernel_instruction_set();
    if (name == "SCALAR" || name == "EMU128") return body(unfused(0.0), name == "SCALAR" ? 1 : 2);
    if (name.starts_with("SSE") || name.starts_with("SSSE")) return body(unfused(0.0), 2);
    body(0.0, name.starts_with("AVX3") ? 8 : name == "AVX2" ? 4 : 2);
  });
}

/// Returns true if two numbers have the same bits or are both NaN.
inline bool same_bits(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b));
}

/// Returns the sum of one number per lane, added as halves of halves.
template <class N>
double sum_of_lanes(std::vector<N> of) {
  for (std::size_t half = of.size() / 2; half > 0; half /= 2)
    for (std::size_t k = 0; k < half; ++k) of[k] = of[k] + of[k + half];
  return value_of(of[0]);
}

/// Returns a number ≥ 0 of any size: zero, subnormal, tiny, ordinary or large, smooth or steep.
inline double any_size(apsis::random_source& random) {
  const double kind = random.uniform(0.0, 1.0), part = random.uniform(0.0, 2.0);
  if (kind < 0.08) return 0.0;
  if (kind < 0.12) return 4.9406564584124654e-324 * std::floor(20.0 * part);
  if (kind < 0.20) return part * 1e-309;
  if (kind < 0.25) return part * 1e-290;
  if (kind < 0.32) return part * 1e-150;
  if (kind < 0.36) return part * 1e60;
  if (kind < 0.39) return part * 1e200;
  if (kind < 0.60) return std::pow(10.0, random.uniform(-3.0, 3.0));
  return 1.0 + 0.1 * part;
}

/// Returns a number of any size and sign.
inline double any_sign(apsis::random_source& random) {
  const double x = any_size(random);
  return random.uniform(0.0, 1.0) < 0.5 ? x : -x;
}

template <class Draw>
std::vector<double> drawn(std::size_t count, apsis::random_source& random, const Draw& draw) {
  std::vector<double> all(count);
  for (double& x : all) x = draw(random);
  return all;
}
