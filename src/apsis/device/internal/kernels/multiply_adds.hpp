#pragma once

#include <apsis/device/internal/lane.hpp>

namespace apsis::kernels {

/// Multiply–adds on numbers in registers, in independent chains: a ceiling of the speed of kernels.
struct multiply_adds {
  static constexpr const char* name = "multiply_adds";  ///< of the kernel
  static constexpr int chains = 8;                      ///< of a lane

  /// Arguments.
  struct arguments {
    double* sums;   ///< of each lane, so that no chain can be left out
    long rounds;    ///< multiply–adds of a chain
    double factor,  ///< of each of them
        addend;     ///< of each of them
  };

  /// The sum of the chains of a lane, by its number in all blocks.
  static APSIS_FORMULA double sum_of(long number, const arguments& of) {
    double x[chains];
    for (int k = 0; k < chains; ++k) x[k] = static_cast<double>(number % 1024) + 0.1 * k;
    for (long round = 0; round < of.rounds; ++round)
      for (int k = 0; k < chains; ++k) x[k] = scalar::fma(x[k], of.factor, of.addend);
    double sum = x[0];
    for (int k = 1; k < chains; ++k) sum = sum + x[k];
    return sum;
  }

  /// Computes the chains of this lane.
  template <class Lane>
  static APSIS_FORMULA void run(const Lane& lane, const arguments& of) {
    const long number = static_cast<long>(lane.block()) * lane.count() + lane.index();
    of.sums[number] = sum_of(number, of);
  }
};

}  // namespace apsis::kernels
