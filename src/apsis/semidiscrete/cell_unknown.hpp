#pragma once

#include <apsis/mesh/grid.hpp>
#include <apsis/velocity/position.hpp>

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// A state u(x): u ← the components at a point of space. At a jump it takes the values of the right side.
using state_function = std::function<void(const position& x, std::span<double> u)>;

/// A point of a cell along the first direction, with its weight in a sum over the cell.
struct weighted_point {
  double offset,  ///< distance from the centre in cell widths, |offset| ≤ ½
      weight;     ///< weight in a sum of weights 1
};

/// The meaning of the numbers of a cell: a linear functional of u(x) in the cell.
class cell_unknown {
 public:
  virtual ~cell_unknown() = default;

  /// Returns the plural noun for messages: "cell averages".
  virtual std::string plural() const = 0;
  /// Returns the value of the functional for ξ², ξ = (x − centre)/Δx: 1/12 for averages, 0 for
  /// values at centres.
  virtual double second_moment() const = 0;
  /// Returns the points of a quadrature of the functional, exact for quartics.
  virtual std::span<const weighted_point> points() const = 0;
  /// Returns true if the functional is the value at one point.
  bool pointwise() const { return points().size() == 1; }

  /// row ← row + the unknowns of u(x) in a cell of width `width` along the first direction; exact to rounding
  /// if u is smooth between the `jumps` (in increasing order). `values` is scratch memory of one row.
  virtual void sample(const state_function& u, const std::vector<double>& jumps, const position& centre,
                      double width, std::span<double> values, double* row) const = 0;

  /// Returns why unknowns of `finer` cells of a line have no counterpart on `cells` cells; "" if
  /// they have one.
  virtual std::string why_not_restricted(int finer, int cells) const;
  /// Returns unknowns of a finer mesh, [cells][components], on a coarser mesh of the same line. Requires
  /// why_not_restricted() to be "".
  virtual std::vector<double> restricted(const std::vector<double>& finer, int components, int cells,
                                         bool periodic) const = 0;
  /// Returns unknowns of a finer mesh, [cells][components], on a coarser mesh of the same box. Directions are
  /// restricted one after the other. Solid boxes divide lines of cells: no value depends on gas beyond a box.
  /// Cells inside boxes become 0. `periodic` has a flag for each direction.
  ///
  /// Requires why_not_restricted() to be "" for the numbers of cells in every direction. Both meshes have the
  /// same solid boxes and no cut cells.
  std::vector<double> restricted_to_mesh(std::vector<double> finer, int components, const grid& fine,
                                         const grid& coarse, const std::array<bool, 3>& periodic) const;
};

/// Cell averages on a line. They are restricted exactly, as averages of averages. The finer number of cells
/// must be a multiple of the coarser one.
const cell_unknown& cell_averages();

/// Values at the centres of cells. They are restricted by the polynomial through the eight nearest centres,
/// or fewer on smaller meshes. Its eighth order preserves the fifth order of the schemes.
const cell_unknown& point_values();

}  // namespace apsis
