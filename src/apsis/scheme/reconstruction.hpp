#pragma once

#include <memory>

namespace apsis {

/// Edge values of a pencil. A pencil is a line of cells; the value of a cell is a row of `width` numbers
/// (one for every velocity), reconstructed each for itself. With cell averages ū_i the results approximate
/// u(x_{i∓1/2}); with point values of a flux function they are the edge fluxes (Shu & Osher 1989).
class reconstruction {
 public:
  virtual ~reconstruction() = default;

  /// Cells needed on either side.
  virtual int ghost_width() const = 0;
  /// Order of accuracy on smooth data.
  virtual int order() const = 0;

  /// For i = 0 … count−1: left[i·width + k] and right[i·width + k] ← edge values of cell i.
  /// rows[i] points to the row of cell i for i = −ghost_width … count−1+ghost_width.
  virtual void edges(const double* const* rows, int count, int width, double* left, double* right) const = 0;

  /// For i = 0 … count−1: edge[i·width + k] ← the edge of cell i through which it flows out, the right one
  /// where forward[k] is 1, the left one where it is 0. All that upwind fluxes of point values need, for half
  /// of the work.
  virtual void outflow_edges(const double* const* rows, int count, int width, const double* forward,
                             double* edge) const = 0;

  /// Operations (exec/counted.hpp) for both edges of one number, or for one edge.
  virtual double operations(bool both_edges) const = 0;
};

}  // namespace apsis
