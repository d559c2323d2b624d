#pragma once

#include <apsis/device/internal/lane.hpp>

namespace apsis::kernels {

/// acc ← (fresh ? 0 : acc) + Σ_k α_k u_k for all numbers of arrays, added in the order of k.
struct combine {
  static constexpr const char* name = "combine";  ///< name of the kernel
  static constexpr int most = 8;                  ///< largest number of terms

  /// Arguments.
  struct arguments {
    double* acc;            ///< the sum
    long size;              ///< how many numbers
    int terms;              ///< how many arrays, at most `most`
    int fresh;              ///< whether the old content of acc is ignored
    double alpha[most];     ///< factors
    const double* u[most];  ///< arrays; acc may be one of them
  };

  /// Computes the numbers of this lane.
  template <class Lane>
  static APSIS_FORMULA void run(const Lane& lane, const arguments& of) {
    const long apart = static_cast<long>(lane.blocks()) * lane.count();
    for (long i = static_cast<long>(lane.block()) * lane.count() + lane.index(); i < of.size; i += apart) {
      double sum = 0.0;
      for (int k = 0; k < of.terms; ++k) {
        const double add = of.alpha[k] * of.u[k][i];
        sum = k == 0 ? (of.fresh != 0 ? add : of.acc[i] + add) : sum + add;
      }
      of.acc[i] = sum;
    }
  }
};

}  // namespace apsis::kernels
