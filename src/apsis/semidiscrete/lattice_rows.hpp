#pragma once

#include <cstddef>

namespace apsis {

/// Loops over the row of one cell along a direction of its velocity lattice, for the instruction set of this
/// processor.
namespace lattice_rows {

/// A row seen along one direction: blocks of points · apart numbers, in which neighbours along the direction
/// lie `apart` numbers from each other.
struct layout {
  int blocks,  ///< lines, or groups of `apart` lines
      points,  ///< of a line
      apart;   ///< distance of neighbouring points

  int block() const { return points * apart; }  ///< numbers of a block
  std::size_t size() const {
    return static_cast<std::size_t>(blocks) * static_cast<std::size_t>(block());
  }  ///< numbers of a row
  std::size_t lines() const {
    return static_cast<std::size_t>(blocks) * static_cast<std::size_t>(apart);
  }  ///< lines of a row
};

/// How the fluxes along a line are found.
struct flux_rule {
  bool fifth_order,    ///< by the linear reconstruction of fifth order, else of first order
      limited,         ///< as upwind::add_limited() does
      forward;         ///< direction of motion
  double inverse_cfl;  ///< 1/κ of the limiter
};

/// Numbers of scratch memory that add_changes() needs for lines of this number of points.
std::size_t scratch_size(int points);

/// sum ← (fresh ? 0 : sum) + rate (flux from the point upstream − flux out) at all points of a row. An edge
/// depends on the values at two points to either side, beyond the ends of lines on vacuum; nothing leaves the
/// last point. into_last[k] ← the flux into the last point of line k, lines of a block together.
void add_changes(const layout& at, const flux_rule& rule, double rate, const double* row, bool fresh,
                 double* sum, double* into_last, double* scratch);

/// acc ← acc + β change for n numbers, and 0 where two roundings of subnormal numbers exceed the value.
void add(const double* change, double beta, int n, double* acc);

}  // namespace lattice_rows
}  // namespace apsis
