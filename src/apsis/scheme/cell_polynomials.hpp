#pragma once

#include <span>
#include <vector>

namespace apsis {

/// Rows on equal cells of a line, [cells][components]: cell averages or values at the centres.
struct line_rows {
  double lower = 0.0,                 ///< lower end of the line
      upper = 1.0;                    ///< upper end
  int cells = 0;                      ///< number of cells
  int components = 0;                 ///< numbers of a row
  std::vector<double> values;         ///< row by row
  double second_moment = 1.0 / 12.0;  ///< 1/12 for averages, 0 for values: ξ², ξ = (x − centre)/width
  /// Returns the width of a cell.
  double width() const { return (upper - lower) / cells; }
  /// Returns value k of a cell.
  double at(int cell, int k) const;
};

/// A parabola in each cell for each component, with the average or the central value of the cell. This is the
/// central WENO reconstruction of third order (Levy, Puppo, Russo, SIAM J. Sci. Comput. 22, 2000) with the
/// weights of Kolb (SIAM J. Numer. Anal. 52, 2014). It does not oscillate at jumps and has full order at
/// extrema. At the ends of the line, the parabola through three cells extrapolates the data. Averages over
/// cells of another mesh preserve the total of averages to rounding.
class cell_polynomials {
 public:
  /// With `nonnegative`, each parabola is scaled towards the value of its cell until it is nonnegative, if
  /// this value is (as in Zhang, Shu, J. Comput. Phys. 229, 2010).
  cell_polynomials(const line_rows& rows, bool nonnegative);

  /// u ← the row at x. Beyond the ends of the line it is the row at the nearest end. Thread-safe.
  void operator()(double x, std::span<double> u) const;
  /// Returns the faces between cells in increasing order, where the row jumps.
  std::vector<double> jumps() const;

 private:
  struct parabola {
    double c0, c1, c2;  ///< c0 + c1 ξ + c2 ξ², ξ = (x − centre)/width
  };
  double lower_, width_;
  int cells_, components_;
  std::vector<parabola> of_;  ///< [cells][components]
};

}  // namespace apsis
