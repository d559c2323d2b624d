#pragma once

namespace apsis {

/// Minimum and number of negative entries of a row.
struct row_extremes {
  double lowest;  ///< minimum; NaN if any number is not finite
  long negative;  ///< number of entries below 0
};

/// Computes the extremes of a row of n ≥ 1 numbers with the instruction set of this processor.
row_extremes compute_extremes(const double* row, int n);

}  // namespace apsis
