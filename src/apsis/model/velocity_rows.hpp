#pragma once

namespace apsis {

/// Sums and functions over the points of one velocity direction, for the instruction set of this processor.
namespace velocity_rows {

/// Points v_j = ½Δv (2j + 1 − n), j = 0 … n−1.
struct points {
  int n;
  double spacing;
};

/// Σ f, Σ v f, Σ ½v² f over rows of n numbers.
struct sums {
  double mass, momentum, energy;
};
sums moments(const double* f, const double* v, const double* half_square, int n);

/// Σ f log f over a row of n numbers ≥ 0, 0 log 0 = 0.
double entropy(const double* f, int n);

/// m_j = a exp(−(v_j − u)²/(2T)), T > 0, in about two multiplications a point: from one vector of points to
/// the next a Gaussian changes by a factor, and that by a constant. It starts where v ≈ u and goes outwards,
/// so that errors stay within some roundings of the largest value, and within 1e-12 of each; below 1e-300
/// values are 0. Very wide and very narrow Gaussians are exponentials.
void gaussian(const points& line, double a, double u, double T, double* m);

}  // namespace velocity_rows
}  // namespace apsis
