#pragma once

#include <apsis/device/internal/lane_group.hpp>
#include <apsis/scheme/formulas/row.hpp>

namespace apsis::kernels {

/// The squares of the rows of two states, compute_squares(): two numbers of every cell, by eight lanes.
struct compare_rows {
  static constexpr const char* name = "compare_rows";  ///< of the kernel
  static constexpr int lanes = 128;                    ///< of a block
  static constexpr int cells = lanes / 8;              ///< of a block
  static constexpr int numbers = 2;                    ///< of a cell: Σ (u − v)², Σ u²

  /// Arguments.
  struct arguments {
    const double *u, *v;  ///< rows of all cells
    double* squares;      ///< of every cell
    long stride;          ///< numbers of a row
    int count,            ///< number of cells
        n;                ///< components
  };

  /// Compares the rows of a cell together with seven other lanes.
  template <class Lane>
  static APSIS_FORMULA void run(const Lane& lane, const arguments& of) {
    const lane_group<Lane> group{lane, lane.shared()};
    const int number = lane.block() * cells + group.group();
    // Lanes behind the last cell take part in the sums.
    const int cell = number < of.count ? number : of.count - 1;
    const auto sums = scalar::sum_squares(group, of.u + cell * of.stride, of.v + cell * of.stride, of.n);
    const double difference = group.total(sums.difference), size = group.total(sums.size);
    if (number >= of.count || group.place() != 0) return;
    of.squares[numbers * number] = difference;
    of.squares[numbers * number + 1] = size;
  }
};

}  // namespace apsis::kernels
