#pragma once

#include <apsis/device/internal/lane.hpp>

namespace apsis::kernels {

/// Executes multiply–adds on numbers in registers, in independent chains. Their rate is a ceiling
/// for kernels.
struct multiply_adds {
  static constexpr const char* name = "multiply_adds";  ///< name of the kernel
  static constexpr int chains = 8;                      ///< chains of a lane

  /// Arguments.
  struct arguments {
    double* sums;   ///< sum of each lane, so that the compiler cannot remove a chain
    long rounds;    ///< multiply–adds of a chain
    double factor,  ///< factor of each multiply–add
        addend;     ///< addend of each multiply–add
  };

  /// Returns the sum of the chains of a lane; `number` counts the lanes of all blocks.
  static APSIS_FORMULA double sum_of(long number, const arguments& of) {
    double x[chains];
    for (int k = 0; k < chains; ++k) x[k] = static_cast<double>(number % 1024) + 0.1 * k;
    for (long round = 0; round < of.rounds; ++round)
      for (double& one : x) one = scalar::fma(one, of.factor, of.addend);
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
