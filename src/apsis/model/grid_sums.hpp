#pragma once

#include <array>

namespace apsis {

/// Sums over all points of a velocity grid in one pass, for the instruction set of this processor. The order
/// of sums does not depend on it.
namespace grid_sums {

/// The last direction of a grid, along which a row is contiguous.
struct axis {
  int n;            ///< number of points
  const double *v,  ///< velocities
      *w;           ///< weights; nullptr: all are 1
};

/// Σ_j w_j c_j^p s_j, p = 0 … 3, c = v − u.
using powers = std::array<double, 4>;
/// Σ_j w_j c_j^p s_j, p = 0 … 5, c = v − u.
using six_powers = std::array<double, 6>;

/// Largest number of functions a_k in a call.
inline constexpr int most_functions = 5;

/// sums[k] ← the powers of s_j = Σ_l a_kl f_lj, where l counts the `lines` lines of the row f. Function a_k
/// has one value per line: a_kl = a[k · lines + l].
void sum(const axis& last, int lines, const double* f, double u, const double* a, int functions,
         powers* sums);
/// Computes the same sums with six powers.
void sum(const axis& last, int lines, const double* f, double u, const double* a, int functions,
         six_powers* sums);

/// s_kj ← Σ_l a_kl f_lj, stored as contiguous rows of n sums.
void sum_lines(const double* f, int lines, int n, const double* a, int functions, double* s);

/// m_lj ← a_l g_j for `lines` lines of n points.
void multiply(const double* a, int lines, const double* g, int n, double* m);

/// h_j ← factor g_j, j = 0 … n−1.
void scale(double factor, const double* g, int n, double* h);

/// Returns Σ_j w_j g_j (log g_j + degrees log(g_j/h_j)) for g, h ≥ 0 with 0 log 0 = 0. Arguments of
/// logarithms are at least the smallest normal number. w = nullptr: all weights are 1; h = nullptr: Σ w g
/// log g.
double entropy(const double* w, const double* g, const double* h, double degrees, int n);

}  // namespace grid_sums
}  // namespace apsis
