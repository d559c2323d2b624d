#pragma once

#include <apsis/integrate/problem.hpp>
#include <apsis/mesh/field.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace apsis {

/// Upwind fluxes between the cells of a pencil, for the instruction set of this processor.
namespace upwind {

/// Some components of cells 0 … count−1 of a pencil.
struct cells {
  const double* const* u;  ///< u[i] is the row of cell i, including two cells beyond each end
  const double *left,      ///< values of cell 0 at its lower edge
      *right;              ///< values at its upper edge; may equal `left`, as only outflow edges are read
  std::ptrdiff_t pitch;    ///< distance between the edges of neighbouring cells
  int count,               ///< number of cells
      width;               ///< number of components
  const double *forward,   ///< for every component: 1 if it moves forward, else 0
      *per_cell,           ///< for every component: |v|/Δx
      *inverse_cfl;        ///< for every component: 1/κ of add_limited(); add() does not read it
  const double* source;    ///< S(u) of cell 0 at the same pitch; null without source
  double *in = nullptr,    ///< row for the upwind values that flow into the first cell, or null
      *out = nullptr;      ///< row for those out of the last cell in the direction of motion, or null
};

/// A row of a target: acc ← (fresh ? 0 : acc) + α u + β T.
struct row_target {
  double* acc;           ///< the row of cell 0
  std::ptrdiff_t pitch;  ///< distance to the row of the next cell
  double alpha,          ///< factor of u
      beta;              ///< factor of T
  bool fresh;            ///< ignore the previous content of acc
};

/// The first component and the distance of the rows of a target.
struct row_places {
  int component = 0;     ///< first component
  int apart = 1;         ///< cells from one row to the next
  bool weighted = true;  ///< whether to include α u and to respect `fresh`
};

/// rows ← the rows of `targets` that begin with a cell.
inline void rows_of(std::span<const target<field, double>> targets, int cell, std::vector<row_target>& rows,
                    const row_places& where = {}) {
  rows.clear();
  for (const auto& to : targets)
    rows.push_back({to.acc->row(cell) + where.component,
                    static_cast<std::ptrdiff_t>(where.apart) * to.acc->stride(),
                    where.weighted ? to.alpha : 0.0, to.beta, where.weighted && to.fresh});
}

/// Adds T = |v|/Δx (inflow − outflow) + source to all targets. Reads edges of cells −1 … count.
void add(const cells& run, std::span<const row_target> targets);

/// Adds T with limited fluxes (limiter::limiter_coefficient). A positive correction of the first-order upwind
/// flux can make its donor cell negative, and a negative one its receiver. Reads edges of cells −2 … count+1.
void add_limited(const cells& run, std::span<const row_target> targets);

/// Returns the operation count per number of add() or add_limited() without targets (exec/counted.hpp), for
/// runs of `cells` cells. The limiter repeats its work in a cell beyond each end.
double operations(bool limited, int cells);
/// Operation count per number and target.
inline constexpr double operations_of_target = 2.0;

/// Adds α u to all targets, for targets with β = 0.
void add_weights(const double* u, int width, std::span<const row_target> targets);

}  // namespace upwind
}  // namespace apsis
