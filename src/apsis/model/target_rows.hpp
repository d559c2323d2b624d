#pragma once

namespace apsis {

/// Loops for targets that are a row times a polynomial, for the instruction set of this processor. Rows
/// consist of contiguous lines of n points in one velocity direction. c = v − u.
namespace target_rows {

/// The polynomial p(c) = k0 + k1 c + k2 c² + k3 c³.
struct cubic {
  double k0 = 1.0,  ///< constant
      k1 = 0.0,     ///< coefficient of c
      k2 = 0.0,     ///< coefficient of c²
      k3 = 0.0;     ///< coefficient of c³
};

/// e ← max(m p(c), −keep f) with one polynomial for each line and f ≥ 0. keep = ∞ stands for e ← m p(c).
/// Returns true if a value was raised to its bound.
bool weigh(const double* m, const double* v, double u, const cubic* of_lines, int lines, const double* f,
           double keep, int n, double* e);

}  // namespace target_rows
}  // namespace apsis
