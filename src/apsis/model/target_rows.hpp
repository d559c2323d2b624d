#pragma once

#include <apsis/model/target_polynomial.hpp>

namespace apsis {

/// Loops for targets that are a row times a polynomial, for the instruction set of this processor.
namespace target_rows {

/// A row of velocities that consists of contiguous lines in its last direction.
struct lines_of_row {
  int dimensions,    ///< number d of directions, 1 to 3
      last,          ///< direction of the lines
      across[2],     ///< the d − 1 other directions
      n,             ///< points of a line
      count;         ///< number of lines
  const double *v,   ///< velocities along a line, in increasing order
      *v_across[2];  ///< velocities of every line in the other directions
  double u,          ///< bulk velocity along a line
      u_across[2];   ///< bulk velocities in the other directions

  /// Returns the number of velocities.
  constexpr long size() const { return static_cast<long>(n) * count; }
};

/// e ← max(m P(v − u), −keep f) for the polynomial P and m ≥ 0. keep = ∞ stands for e ← m P(v − u),
/// and f is not read. The rows m and e may be the same. Returns true if a value was raised to its bound.
bool weigh(const double* m, const target_polynomial& p, const lines_of_row& of, const double* f, double keep,
           double* e);

}  // namespace target_rows
}  // namespace apsis
