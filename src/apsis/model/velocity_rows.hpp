#pragma once

#include <cstddef>

namespace apsis {

/// Sums and functions over the points of one velocity direction, for the instruction set of this processor.
namespace velocity_rows {

/// Points v_j = ½Δv (2j + 1 − n), j = 0 … n−1.
struct points {
  int n;           ///< number of points
  double spacing;  ///< Δv
};

/// Sums over a row, without the factor Δv.
struct sums {
  double mass,   ///< Σ f
      momentum,  ///< Σ v f
      energy;    ///< Σ ½v² f
};
/// Numbers of a row that are added in one chain per lane; longer rows are halved until they are as short.
inline constexpr int longest_chain = 256;
/// Those of some rows of n numbers, which lie `pitch` apart; v and half_square are v and ½v² of the points.
/// Sums of a row do not depend on the others.
void moments(const double* f, std::ptrdiff_t pitch, int rows, const double* v, const double* half_square,
             int n, sums* of_rows);

/// a exp(−(v − u)²/(2T)), T > 0.
struct gaussian {
  double a,  ///< height
      u,     ///< centre
      T;     ///< square of the width
};

/// The values of some Gaussians at all points, rows `pitch` apart, in about two multiplications a point: from
/// one vector of points to the next a Gaussian changes by a factor, and that by a constant. It starts where
/// v ≈ u and goes outwards, so that errors stay within some roundings of the largest value, and within 1e-12
/// of each; below 1e-300 values are 0. Very wide and very narrow Gaussians, and those of a few points, are
/// exponentials. A row does not depend on the others; several share the cost of their first vectors.
void gaussians(const points& line, const gaussian* of_rows, int rows, double* m, std::ptrdiff_t pitch);

/// The values of a Gaussian at any n points v, as exponentials; below 1e-300 they are 0.
void gaussian_at(const double* v, int n, const gaussian& of, double* m);

/// x ← e^(x − shift) for n numbers with x − shift ≤ 700.
void exponentials(double shift, int n, double* x);

}  // namespace velocity_rows
}  // namespace apsis
