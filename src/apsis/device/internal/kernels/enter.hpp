#pragma once

#include <apsis/device/internal/lane.hpp>
#include <apsis/semidiscrete/formulas/face.hpp>

namespace apsis::kernels {

/// acc ← acc + β (v·n/Δx) value for the components that enter through surfaces, in the cells at the surfaces.
/// A launch has at most one surface for each cell.
struct enter {
  static constexpr const char* name = "enter";  ///< name of the kernel

  /// Arguments.
  struct arguments {
    double* acc;           ///< rows of all cells
    const double* values;  ///< rows at surfaces
    const double* inward;  ///< rows of v·n, n into the gas, of every kind of surface
    const int* ends;       ///< [end]: cell, row of `values`, row of `inward`
    long stride;           ///< numbers of a row
    long count;            ///< number of ends
    double beta,           ///< factor of T
        spacing;           ///< Δx
  };

  /// Adds the numbers of this lane.
  template <class Lane>
  static APSIS_FORMULA void run(const Lane& lane, const arguments& of) {
    const long apart = static_cast<long>(lane.blocks()) * lane.count(), all = of.count * of.stride;
    for (long i = static_cast<long>(lane.block()) * lane.count() + lane.index(); i < all; i += apart) {
      const int* end = of.ends + 3 * (i / of.stride);
      const long k = i % of.stride;
      double& acc = of.acc[end[0] * of.stride + k];
      acc = scalar::with_entering(acc, of.beta, of.inward[end[2] * of.stride + k], of.spacing,
                                  of.values[end[1] * of.stride + k]);
    }
  }
};

}  // namespace apsis::kernels
