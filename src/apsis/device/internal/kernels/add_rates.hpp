#pragma once

#include <apsis/device/internal/lane.hpp>
#include <apsis/semidiscrete/formulas/cut_cell.hpp>

namespace apsis::kernels {

/// acc ← (fresh ? 0 : acc) + α u + β T in some cells, with T from the host.
struct add_rates {
  static constexpr const char* name = "add_rates";  ///< name of the kernel

  /// Arguments.
  struct arguments {
    double* acc;       ///< rows of all cells
    const double *u,   ///< rows of all cells
        *rates;        ///< rows of T
    const int* cells;  ///< [cell]: number of the cell, row of `rates`
    long stride;       ///< numbers of a row
    long count;        ///< how many cells
    double alpha,      ///< factor of u
        beta;          ///< factor of T
    int fresh;         ///< whether the old content of acc is ignored
  };

  /// Adds the numbers of this lane.
  template <class Lane>
  static APSIS_FORMULA void run(const Lane& lane, const arguments& of) {
    const long apart = static_cast<long>(lane.blocks()) * lane.count(), all = of.count * of.stride;
    for (long i = static_cast<long>(lane.block()) * lane.count() + lane.index(); i < all; i += apart) {
      const int* cell = of.cells + 2 * (i / of.stride);
      const long k = i % of.stride, at = cell[0] * of.stride + k;
      of.acc[at] = scalar::with_rate(of.u[at], of.rates[cell[1] * of.stride + k], of.alpha, of.beta,
                                     of.fresh != 0, [&]() APSIS_INLINED { return of.acc[at]; });
    }
  }
};

}  // namespace apsis::kernels
