#pragma once

#include <apsis/scheme/nodes.hpp>

#include <array>

namespace apsis {

/// The quartic on a cell (ξ ∈ [−½, ½]) with edge values L, R and averages c, m, p over the cell and its left
/// and right neighbours. The three-point Gauss–Legendre rule integrates it exactly, so that the weighted mean
/// of the Gauss values is c. The coefficients are differences from c. Constant data are therefore reproduced
/// without rounding, and steps do not drift.
struct quartic {
  double c,  ///< average
      d0,    ///< value minus average at the centre
      d1,    ///< coefficient of ξ
      d2,    ///< coefficient of ξ²
      d3,    ///< coefficient of ξ³
      d4;    ///< coefficient of ξ⁴

  /// Builds the quartic from the averages of the left neighbour, the cell and the right neighbour, and the
  /// edge values L and R.
  quartic(double m, double average, double p, double l, double r) : c(average) {
    const double edges = (l - c) + (r - c), slope = r - l;
    const double neighbours = (m - c) + (p - c), rise = p - m;
    d0 = -9.0 / 32.0 * edges + neighbours * (1.0 / 192.0);
    d1 = 1.25 * slope - 0.125 * rise;
    d2 = 3.75 * edges - 0.125 * neighbours;
    d3 = 0.5 * rise - slope;
    d4 = -2.5 * edges + 5.0 / 12.0 * neighbours;
  }

  /// Returns the value at ξ minus the average.
  double deviation(double xi) const { return d0 + xi * (d1 + xi * (d2 + xi * (d3 + xi * d4))); }
  /// Returns the value at ξ.
  double operator()(double xi) const { return c + deviation(xi); }
};

/// Three-point Gauss–Legendre rule on [−½, ½].
struct gauss3 {
  static constexpr int points = 3;                                   ///< number of nodes
  static constexpr double outer = gauss3_outer;                      ///< √(3/5)/2
  static constexpr std::array<double, 3> xi = {-outer, 0.0, outer};  ///< nodes
  /// Weights, which sum to exactly 1 in floating point.
  static constexpr std::array<double, 3> weight = {5.0 / 18.0, 1.0 - 2.0 * (5.0 / 18.0), 5.0 / 18.0};
};

}  // namespace apsis
