#pragma once

namespace apsis {

/// A Gaussian of two components x and y on evenly spaced rows x. One row has the values at all y. From row to
/// row each value changes by a factor exp(α − βy), and this factor changes by the same factor everywhere.
struct plane_walk {
  double height,         ///< the first row is height · exp(−(v − centre)²/(2T)) at velocities v = u + y
      centre,            ///< its centre
      T;                 ///< the square of its width
  double u;              ///< bulk velocity along a row
  double log_of_factor,  ///< α from the first row to the next
      slope,             ///< β
      log_of_change;     ///< logarithm of the change of the factor
  int rows,              ///< number of rows
      first;             ///< number of the first row; the walk proceeds from it to both ends
};

}  // namespace apsis
