#pragma once

namespace apsis {

/// Minimum and number of negative entries of a row.
struct row_extremes {
  double lowest;  ///< minimum; NaN if any number is not finite
  long negative;  ///< number of entries below 0
};

/// Computes the extremes of a row of n ≥ 1 numbers with the instruction set of this processor.
row_extremes compute_extremes(const double* row, int n);

/// Sums of squares over a row u.
struct row_squares {
  double difference = 0.0,  ///< Σ (u − v)²
      size = 0.0;           ///< Σ u²
};

/// Computes the sums for two rows u and v of n numbers, in an order that does not depend on the processor.
row_squares compute_squares(const double* u, const double* v, int n);

}  // namespace apsis
