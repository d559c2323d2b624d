#pragma once

#include <apsis/device/internal/lane.hpp>

namespace apsis::kernels {

/// Gathers rows: row n of `to` ← row cells[n] of u.
struct copy_rows {
  static constexpr const char* name = "copy_rows";  ///< name of the kernel

  /// Arguments.
  struct arguments {
    const double* u;   ///< rows of all cells
    const int* cells;  ///< numbers of cells
    double* to;        ///< rows one after the other
    long stride;       ///< numbers of a row
    long rows;         ///< how many rows
  };

  /// Copies the numbers of this lane.
  template <class Lane>
  static APSIS_FORMULA void run(const Lane& lane, const arguments& of) {
    const long apart = static_cast<long>(lane.blocks()) * lane.count(), all = of.rows * of.stride;
    for (long i = static_cast<long>(lane.block()) * lane.count() + lane.index(); i < all; i += apart)
      of.to[i] = of.u[of.cells[i / of.stride] * of.stride + i % of.stride];
  }
};

}  // namespace apsis::kernels
