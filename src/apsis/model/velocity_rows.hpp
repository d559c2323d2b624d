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

/// Sums over a row of values f, without the factor Δv.
struct sums {
  double mass,   ///< Σ f
      momentum,  ///< Σ v f
      energy;    ///< Σ ½v² f
};
/// Most numbers of a row that are summed in one pass. Longer rows are halved until they are as short.
inline constexpr int longest_chain = 256;
/// of_rows ← the sums of rows of n numbers, which lie `pitch` numbers apart. `v` and `half_square` are v and
/// ½v² at the points. The sums of a row do not depend on other rows.
void moments(const double* f, std::ptrdiff_t pitch, int rows, const double* v, const double* half_square,
             int n, sums* of_rows);

/// The function a exp(−(v − u)²/(2T)), T > 0.
struct gaussian {
  double a,  ///< height
      u,     ///< centre
      T;     ///< square of the width
};

/// m ← the values of Gaussians at all points, in rows that lie `pitch` numbers apart. This takes about two
/// multiplications per point: from one vector of points to the next a Gaussian changes by a factor, and this
/// factor by a constant factor. The recursion starts where v ≈ u and proceeds outwards. Errors therefore stay
/// within some roundings of the largest value, and within 1e-12 of each value. Values below 1e-300 become 0.
///
/// Very wide or narrow Gaussians, and those on few points, are computed as exponentials. A row does not
/// depend on other rows. Several rows share the cost of their first vectors.
void gaussians(const points& line, const gaussian* of_rows, int rows, double* m, std::ptrdiff_t pitch);

/// m ← the values of a Gaussian at any n points v, as exponentials. Values below 1e-300 become 0.
void gaussian_at(const double* v, int n, const gaussian& of, double* m);

/// x ← e^(x − shift) for n numbers with x − shift ≤ 700.
void exponentials(double shift, int n, double* x);

}  // namespace velocity_rows
}  // namespace apsis
