#pragma once

#include <memory>

namespace apsis {

/// Reconstruction scheme: edge values of a pencil. A pencil is a line of cells; the value of a cell is a row
/// of `width` numbers (one per velocity), each reconstructed independently. For cell averages ū_i the results
/// approximate u(x_{i∓1/2}); for point values of a flux function they are edge fluxes (Shu & Osher 1989).
class reconstruction {
 public:
  virtual ~reconstruction() = default;

  /// Number of ghost cells needed on either side.
  virtual int ghost_width() const = 0;
  /// Order of accuracy on smooth data.
  virtual int order() const = 0;

  /// Computes, for i = 0 … count−1, the edge values left[i·width + k] and right[i·width + k] of cell i.
  /// rows[i] points to the row of cell i for i = −ghost_width … count−1+ghost_width.
  virtual void edges(const double* const* rows, int count, int width, double* left, double* right) const = 0;

  /// Computes, for i = 0 … count−1, the outflow edge edge[i·width + k] of cell i: the right one
  /// where forward[k] is 1, the left one where it is 0. Upwind fluxes of point values need no more,
  /// at half the work. By default edges() is called and one of them selected.
  virtual void outflow_edges(const double* const* rows, int count, int width, const double* forward,
                             double* edge) const;

  /// Operation count (exec/counted.hpp) per number, for both edges or one; 0, the default: not counted, so
  /// that `apsis run --profile` shows times alone.
  virtual double operations(bool both_edges) const;
};

}  // namespace apsis
