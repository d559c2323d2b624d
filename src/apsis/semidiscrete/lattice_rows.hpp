#pragma once

#include <cstddef>

namespace apsis {

/// Loops over the row of one cell along a direction of its velocity lattice, for the instruction set of this
/// processor.
namespace lattice_rows {

/// The layout of a row along one direction: blocks of points · apart numbers. Neighbours along the direction
/// are `apart` numbers apart.
struct layout {
  int blocks,  ///< lines, or groups of `apart` lines
      points,  ///< points of a line
      apart;   ///< distance of neighbouring points

  int block() const { return points * apart; }  ///< numbers of a block
  std::size_t size() const {
    return static_cast<std::size_t>(blocks) * static_cast<std::size_t>(block());
  }  ///< numbers of a row
  std::size_t lines() const {
    return static_cast<std::size_t>(blocks) * static_cast<std::size_t>(apart);
  }  ///< lines of a row
};

/// The rule for the fluxes along a line.
struct flux_rule {
  bool fifth_order,    ///< linear reconstruction of fifth order; else first order
      limited,         ///< limited like upwind::add_limited()
      forward;         ///< true for motion to larger indices
  double inverse_cfl;  ///< 1/κ of the limiter
};

/// Returns the size of the scratch memory of add_changes(), in numbers, for lines of this many points.
std::size_t scratch_size(int points);

/// sum ← (fresh ? 0 : sum) + rate (flux from the point upstream − flux out) at all points of a row. An edge
/// depends on the values at two points on each side, with a vacuum beyond the ends of lines. Nothing leaves
/// the last point. into_last[k] ← the flux into the last point of line k; lines of a block are consecutive.
void add_changes(const layout& at, const flux_rule& rule, double rate, const double* row, bool fresh,
                 double* sum, double* into_last, double* scratch);

/// acc ← acc + β change for n numbers. Results become 0 if two roundings of subnormal numbers
/// exceed the value.
void add(const double* change, double beta, int n, double* acc);

}  // namespace lattice_rows
}  // namespace apsis
