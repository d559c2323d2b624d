#pragma once

#include <apsis/integrate/problem.hpp>
#include <apsis/phase/field.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace apsis {

/// What flows between the cells of a pencil: the work of transport on a run of cells, for the instruction set
/// of this processor.
namespace upwind {

/// Cells 0 … count−1 of a pencil, some components of each.
struct cells {
  const double* const* u;  ///< u[i] is the row of cell i, two cells beyond either end included
  const double *left,      ///< values of cell 0 at its lower edge
      *right;              ///< at its upper edge; only that of the outflow is read, so they may be the same
  std::ptrdiff_t pitch;    ///< from the edges of a cell to those of the next
  int count,               ///< number of cells
      width;               ///< number of components
  const double *forward,   ///< of every component: 1 if it moves forward, else 0
      *per_cell;           ///< of every component: |v|/Δx
  const double* source;    ///< S(u) of cell 0, at the same pitch; null if there is none
};

/// acc ← (fresh ? 0 : acc) + α u + β T.
struct row_target {
  double* acc;           ///< the row of cell 0
  std::ptrdiff_t pitch;  ///< to that of the next cell
  double alpha,          ///< factor of u
      beta;              ///< factor of T
  bool fresh;            ///< the old content of acc means nothing
};

/// Where the rows of a target begin, and how far they are apart.
struct row_places {
  int component = 0;     ///< of the first number
  int apart = 1;         ///< cells from one row to the next
  bool weighted = true;  ///< u itself counts, and old content may be forgotten
};

/// Into `rows`, what `targets` say from a cell on.
inline void rows_of(std::span<const target<field, double>> targets, int cell, std::vector<row_target>& rows,
                    const row_places& where = {}) {
  rows.clear();
  for (const auto& to : targets)
    rows.push_back({to.acc->row(cell) + where.component,
                    static_cast<std::ptrdiff_t>(where.apart) * to.acc->stride(),
                    where.weighted ? to.alpha : 0.0, to.beta, where.weighted && to.fresh});
}

/// T = |v|/Δx (inflow − outflow) + source into all targets. Edges of cells −1 … count are read.
void add(const cells& run, std::span<const row_target> targets);

/// The same with each flux limited to what its donor and its receiver can bear (limiter::harmless_fraction):
/// a positive correction of first-order upwind harms the donor, a negative one the receiver. Edges of cells
/// −2 … count+1 are read.
void add_limited(const cells& run, std::span<const row_target> targets);

/// Operations of add, or of add_limited, that T takes for one number (exec/counted.hpp).
double operations(bool limited);
/// Additional operations per number and target.
inline constexpr double operations_of_target = 4.0;

/// One row, for targets that need u alone: β = 0 everywhere.
void add_weights(const double* u, int width, std::span<const row_target> targets);

}  // namespace upwind
}  // namespace apsis
