#pragma once

#include <apsis/velocity/position.hpp>

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// A state u(x): u ← the components at a point of space; at a jump, those of its right side.
using state_function = std::function<void(const position& x, std::span<double> u)>;

/// A point of a cell along the first direction, with its weight in a sum over the cell.
struct weighted_point {
  double offset,  ///< from the centre, in cell widths: |offset| ≤ ½
      weight;     ///< of a sum of weights 1
};

/// The meaning of the number of a cell and component: a linear functional of u(x) in the cell.
class cell_unknown {
 public:
  virtual ~cell_unknown() = default;

  /// Returns the plural noun of messages: "cell averages".
  virtual std::string plural() const = 0;
  /// Returns its value for ξ², ξ = (x − centre)/Δx: 1/12 for averages, 0 for values at centres.
  virtual double second_moment() const = 0;
  /// Returns the points of a quadrature of it, exact for quartics.
  virtual std::span<const weighted_point> points() const = 0;
  /// Whether it is the value at one point.
  bool pointwise() const { return points().size() == 1; }

  /// row ← row + the unknowns of u(x) in a cell of width `width` along the first direction; exact to rounding
  /// if u is smooth between the `jumps` (in increasing order). `values` is scratch memory of one row.
  virtual void sample(const state_function& u, const std::vector<double>& jumps, const position& centre,
                      double width, std::span<double> values, double* row) const = 0;

  /// Returns why unknowns of `finer` cells of a line have no counterpart on `cells` cells; "" if they have.
  virtual std::string why_not_restricted(int finer, int cells) const;
  /// Returns unknowns of a finer mesh, [cells][components], on a coarser mesh of the same line. Requires
  /// why_not_restricted() to be "".
  virtual std::vector<double> restricted(const std::vector<double>& finer, int components, int cells,
                                         bool periodic) const = 0;
};

/// Averages over cells of a line. Restricted exactly, as averages of averages; the number of cells must be a
/// multiple.
const cell_unknown& cell_averages();

/// Values at the centres of cells. Restricted by the polynomial through the eight nearest centres (eighth
/// order, to preserve the fifth order of the schemes; fewer points on smaller meshes).
const cell_unknown& point_values();

}  // namespace apsis
