#pragma once

#include <apsis/exec/aligned.hpp>

#include <algorithm>
#include <chrono>
#include <cstddef>

namespace apsis::bench {

/// Measures the bytes per second of a = b + s·c on arrays of `count` doubles each, 24 bytes per element.
/// Returns the best of several runs, because a ceiling is the performance of an undisturbed machine.
inline double triad_bytes_per_second(std::size_t count) {
  aligned_vector<double> a(count, 0.0), b(count, 1.0), c(count, 2.0);
  const std::size_t sweeps = std::max<std::size_t>(1, (std::size_t{1} << 22) / count);
  double best = 0.0;
  for (int run = 0; run < 10; ++run) {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t sweep = 0; sweep < sweeps; ++sweep) {
      const double s = 1.0 + 1e-9 * static_cast<double>(sweep);
      for (std::size_t i = 0; i < count; ++i) a[i] = b[i] + s * c[i];
      // Marks the array as used, so that the compiler cannot remove a sweep.
      asm volatile("" : : "r"(a.data()) : "memory");
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    best = std::max(best, 24.0 * static_cast<double>(count * sweeps) / seconds.count());
  }
  return best;
}

/// Returns the rate of `elements` processed since `start` as a fraction of the rate of the triad on arrays of
/// `count` doubles. Each element must move at least 24 bytes, like one of the triad.
inline double fraction_of_triad(double elements, std::chrono::steady_clock::time_point start,
                                std::size_t count) {
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  return 24.0 * elements / seconds.count() / triad_bytes_per_second(count);
}

}  // namespace apsis::bench
