#pragma once

#include <cstddef>

namespace apsis {

/// Loops over the row of one cell along a direction of its velocity lattice, for the instruction set of this
/// processor.
namespace lattice_rows {

/// A row laid out along one direction: `blocks` blocks of points · apart numbers, each followed by gap ·
/// apart zeros, and as many zeros before the first and behind the last block. Neighbours along the direction
/// lie `apart` numbers from each other, for all numbers alike, so that one loop over places passes all lines.
struct layout {
  int blocks,  ///< lines, or groups of `apart` lines
      points,  ///< of a line
      apart;   ///< distance of neighbouring points

  static constexpr int gap = 2;  ///< points of vacuum between blocks, on which the last edges depend

  int block() const { return points * apart; }          ///< numbers of a block
  int pitch() const { return (points + gap) * apart; }  ///< distance of blocks
  int lanes() const { return blocks * pitch(); }        ///< places of blocks and the gaps behind them
  bool operator==(const layout&) const = default;       ///< equal numbers
  int first() const { return gap * apart; }             ///< place of the first point
  std::size_t size() const {  ///< numbers of an array with this layout, for whole vectors of up to 8
    return static_cast<std::size_t>(lanes()) + 2 * static_cast<std::size_t>(first()) + 8;
  }
};

/// How the fluxes along a line are found.
struct flux_rule {
  bool fifth_order,    ///< by the linear reconstruction of fifth order, else of first order
      limited,         ///< as upwind::add_limited() does
      forward;         ///< direction of motion
  double inverse_cfl;  ///< 1/κ of the limiter
};

/// Arrays of places. Between lines, before the first and behind the last one numbers are 0; find_fluxes()
/// needs that before the first line, and keeps it.
struct places {
  double *values,    ///< of the row
      *edges,        ///< downstream of each point
      *low_order,    ///< edges of first order
      *fractions,    ///< that the limiter leaves of corrections
      *limited_out;  ///< limited fluxes

  /// Returns the fluxes out of each point, none out of the last one.
  double* fluxes(const flux_rule& rule) const { return rule.limited ? limited_out : edges; }
};

/// Finds the fluxes of a row. An edge depends on the values at two points to either side, beyond the ends of
/// lines on vacuum.
void find_fluxes(const layout& at, const flux_rule& rule, const double* row, const places& to);

/// sum ← (fresh ? 0 : sum) + rate (out of the point upstream − out) at all points of a row. `out` are fluxes
/// out of points with this layout; `forward` is the direction of motion.
void add_differences(const layout& at, const double* out, bool forward, double rate, bool fresh, double* sum);

/// acc ← acc + β change for n numbers, and 0 where two roundings of subnormal numbers exceed the value.
void add(const double* change, double beta, int n, double* acc);

}  // namespace lattice_rows
}  // namespace apsis
