#pragma once

namespace apsis {

/// What a monitor asks of a row of numbers.
struct row_extremes {
  double lowest;  ///< the smallest; NaN if any number is not finite
  long negative;  ///< how many are below 0
};

/// For the instruction set of this processor. n ≥ 1.
row_extremes find_extremes(const double* row, int n);

}  // namespace apsis
