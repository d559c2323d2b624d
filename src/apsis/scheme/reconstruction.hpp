#pragma once

#include <memory>

namespace apsis {

/// A reconstruction scheme, which computes edge values on a pencil, a line of cells. The value of a cell is a
/// row of `width` numbers (one per velocity), which are reconstructed independently. For cell averages ū_i
/// the results approximate u(x_{i∓1/2}). For point values of a flux function they are edge fluxes (Shu &
/// Osher 1989). Units are those of the data.
class reconstruction {
 public:
  virtual ~reconstruction() = default;

  /// Returns the number of ghost cells that the scheme needs on either side.
  virtual int ghost_width() const = 0;
  /// Returns the order of accuracy on smooth data.
  virtual int order() const = 0;

  /// Computes, for i = 0 … count−1, the edge values left[i·width + k] and right[i·width + k] of cell i.
  /// rows[i] points to the row of cell i for i = −ghost_width … count−1+ghost_width.
  virtual void edges(const double* const* rows, int count, int width, double* left, double* right) const = 0;

  /// Computes, for i = 0 … count−1, the outflow edge edge[i·width + k] of cell i. It is the right edge if
  /// forward[k] is 1, the left edge if it is 0. Upwind fluxes of point values need only these edges, at half
  /// the work. The default calls edges() and selects one of them.
  virtual void outflow_edges(const double* const* rows, int count, int width, const double* forward,
                             double* edge) const;

  /// Returns the operation count (exec/counted.hpp) per number, for both edges or one. 0, the default, means
  /// that operations are not counted; `apsis run --profile` then shows only times.
  virtual double operations(bool both_edges) const;
};

}  // namespace apsis
