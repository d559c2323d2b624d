#pragma once

#include <array>

namespace apsis {

/// The quartic on one cell (ξ ∈ [−½, ½]) through the edge values L, R whose averages on the cell and its two
/// neighbours are c, m, p; three-point Gauss–Legendre is exact on it, so the weighted mean of the Gauss
/// values is c.
struct quartic {
  double a0, a1, a2, a3, a4;

  quartic(double m, double c, double p, double l, double r)
      : a0(-9.0 / 32.0 * (l + r) + 149.0 / 96.0 * c + (m + p) * (1.0 / 192.0)),
        a1(1.25 * (r - l) + 0.125 * (m - p)),
        a2(3.75 * (l + r) - 7.25 * c - 0.125 * (m + p)),
        a3(l - r + 0.5 * (p - m)),
        a4(-2.5 * (l + r) + 25.0 / 6.0 * c + 5.0 / 12.0 * (m + p)) {}

  double operator()(double xi) const { return a0 + xi * (a1 + xi * (a2 + xi * (a3 + xi * a4))); }
};

/// Three-point Gauss–Legendre rule on [−½, ½].
struct gauss3 {
  static constexpr int points = 3;
  static constexpr double outer = 0.38729833462074168852;  ///< √(3/5)/2
  static constexpr std::array<double, 3> xi = {-outer, 0.0, outer};
  static constexpr std::array<double, 3> weight = {5.0 / 18.0, 1.0 - 2.0 * (5.0 / 18.0), 5.0 / 18.0};
};

/// Interior nodes ±1/(2√5) of the four-point Gauss–Lobatto rule on [−½, ½].
inline constexpr double lobatto4_inner = 0.22360679774997896964;

}  // namespace apsis
