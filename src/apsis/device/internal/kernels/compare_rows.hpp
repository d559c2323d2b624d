#pragma once

#include <apsis/device/internal/lane_group.hpp>
#include <apsis/scheme/formulas/row.hpp>

namespace apsis::kernels {

/// Computes the squares of the rows of two states, as compute_squares(): two numbers of every cell, with
/// eight lanes for each.
struct compare_rows {
  static constexpr const char* name = "compare_rows";  ///< name of the kernel
  static constexpr int lanes = 128;                    ///< lanes of a block
  static constexpr int cells = lanes / 8;              ///< cells of a block
  static constexpr int numbers = 2;                    ///< numbers of a cell: Σ (u − v)², Σ u²

  /// Arguments.
  struct arguments {
    const double *u, *v;  ///< rows of all cells
    double* squares;      ///< squares of every cell
    long stride;          ///< numbers of a row
    int count,            ///< number of cells
        n;                ///< components
  };

  /// Compares the rows of a cell together with seven other lanes.
  template <class Lane>
  static APSIS_FORMULA void run(const Lane& lane, const arguments& of) {
    const lane_group<Lane> group{lane, lane.shared()};
    const int number = lane.block() * cells + group.group();
    // Lanes beyond the last cell take part in the sums.
    const int cell = number < of.count ? number : of.count - 1;
    const auto sums = scalar::sum_squares(group, of.u + cell * of.stride, of.v + cell * of.stride, of.n);
    const double difference = group.total(sums.difference), size = group.total(sums.size);
    if (number >= of.count || group.place() != 0) return;
    of.squares[numbers * number] = difference;
    of.squares[numbers * number + 1] = size;
  }
};

}  // namespace apsis::kernels
