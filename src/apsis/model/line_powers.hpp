#pragma once

#include <apsis/model/line_moments.hpp>

#include <array>

namespace apsis {

/// Central moments of weights along one direction of a velocity grid, and products of the weights with
/// exponentials of parabolas. Loops are compiled for the instruction set of this processor. The order of sums
/// does not depend on it. c = v − u.
namespace line_powers {

/// Points of a line.
struct points {
  int n;            ///< number of points
  const double *v,  ///< velocities
      *b;           ///< weights of the quadrature; nullptr: all are 1
};

/// Σ_j b_j w_j c_j^p, p = 0 … 5.
using sums = std::array<double, line_moments::powers>;

/// Returns the sums of n weights w.
sums sum(const points& line, double u, const double* w);

/// w ← w e^(βc + γc²) for exponents of at most small_exponent (model/formulas/exponential.hpp). Returns the
/// sums of the new weights.
sums change(const points& line, double u, double beta, double gamma, double* w);

}  // namespace line_powers
}  // namespace apsis
