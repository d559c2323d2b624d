#pragma once

#include <apsis/semidiscrete/upwind_rows.hpp>

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
  std::size_t size() const {                            ///< numbers of an array with this layout
    return static_cast<std::size_t>(lanes()) + 2 * static_cast<std::size_t>(first());
  }
};

/// Copies a row to the places of its points; gaps stay as they are.
void lay_out(const layout& at, const double* row, double* places);

/// Sets the numbers of the gaps behind blocks to 0.
void clear_gaps(const layout& at, double* places);

/// Sets the numbers of the last points to 0, the first ones of lines where motion is not `forward`.
void clear_ends(const layout& at, bool forward, double* places);

/// sum ← sum + rate (out of the point upstream − out) at all points of a row. `out` are fluxes out of points
/// with this layout; `forward` is the direction of motion.
void add_differences(const layout& at, const double* out, bool forward, double rate, double* sum);

/// acc ← acc + β change for n numbers, and 0 where two roundings of subnormal numbers exceed the value.
void add(const double* change, double beta, int n, double* acc);

}  // namespace lattice_rows
}  // namespace apsis
