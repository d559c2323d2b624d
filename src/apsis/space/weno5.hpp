#pragma once

#include <algorithm>
#include <cmath>

namespace apsis::weno5 {

/// Fifth-order WENO edge values of one cell from five neighbours a … e (cells i−2 … i+2), c the cell itself.
/// Three third-order candidates at each edge are weighted by (linear weight) × g_k, where g_k depends on the
/// indicators of smoothness β_k (Jiang & Shu, JCP 126, 1996). Right edge: linear weights (1, 6, 3)/10; left
/// edge by mirror symmetry.
struct smoothness {
  double s0, s1, s2;
  double mean_square;  ///< of the five values
};

inline smoothness indicators(double a, double b, double c, double d, double e) {
  const double x0 = a - 2 * b + c, y0 = a - 4 * b + 3 * c;
  const double x1 = b - 2 * c + d, y1 = b - d;
  const double x2 = c - 2 * d + e, y2 = 3 * c - 4 * d + e;
  constexpr double q = 13.0 / 12.0;
  return {q * x0 * x0 + 0.25 * y0 * y0, q * x1 * x1 + 0.25 * y1 * y1, q * x2 * x2 + 0.25 * y2 * y2,
          0.2 * (a * a + b * b + c * c + d * d + e * e)};
}

/// β_k + δ divided by the largest of them, and kept above 1e-40: products of four of these neither overflow
/// nor underflow, whatever the size of the data. Where the data are so small that only δ is left, all three
/// are 1.
struct scaled_smoothness {
  double y0, y1, y2, per_largest;
};

inline scaled_smoothness scale(const smoothness& s, double delta) {
  constexpr double floor = 1e-40;
  const double x0 = s.s0 + delta, x1 = s.s1 + delta, x2 = s.s2 + delta;
  const double per_largest = 1.0 / std::max(x0, std::max(x1, x2));
  return {x0 * per_largest + floor, x1 * per_largest + floor, x2 * per_largest + floor, per_largest};
}

/// g_k > 0 up to a common factor: a ratio such as 1/y₀² is written y₁² y₂², over one common denominator.
struct factors {
  double g0, g1, g2;
};

inline void edge_values(double a, double b, double c, double d, double e, const factors& g, double& left,
                        double& right) {
  constexpr double sixth = 1.0 / 6.0;
  const double r0 = 2 * a - 7 * b + 11 * c, r1 = -b + 5 * c + 2 * d, r2 = 2 * c + 5 * d - e;
  const double l0 = -a + 5 * b + 2 * c, l1 = 2 * b + 5 * c - d, l2 = 11 * c - 7 * d + 2 * e;
  const double middle = 6 * g.g1;
  const double right_sum = g.g0 + middle + 3 * g.g2, left_sum = 3 * g.g0 + middle + g.g2;
  const double inverse = sixth / (right_sum * left_sum);  // one division for both edges
  right = (g.g0 * r0 + middle * r1 + 3 * g.g2 * r2) * (left_sum * inverse);
  left = (3 * g.g0 * l0 + middle * l1 + g.g2 * l2) * (right_sum * inverse);
}

/// Applies `weights(smoothness) → factors` along a pencil; see reconstruction::edges for the arguments.
template <class Weights>
void sweep(const double* const* rows, int count, int width, double* left, double* right, Weights weights) {
  for (int i = 0; i < count; ++i) {
    const double* a = rows[i - 2];
    const double* b = rows[i - 1];
    const double* c = rows[i];
    const double* d = rows[i + 1];
    const double* e = rows[i + 2];
    double* l = left + static_cast<long>(i) * width;
    double* r = right + static_cast<long>(i) * width;
#pragma omp simd
    for (int k = 0; k < width; ++k)
      edge_values(a[k], b[k], c[k], d[k], e[k], weights(indicators(a[k], b[k], c[k], d[k], e[k])), l[k],
                  r[k]);
  }
}

}  // namespace apsis::weno5
