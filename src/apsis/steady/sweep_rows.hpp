#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace apsis {

/// The implicit upwind equations of one cell, for the instruction set of this processor.
namespace sweep_rows {

/// Consecutive components.
struct strip {
  int begin = 0,  ///< the first one
      end = 0;    ///< behind the last one
};

/// The terms of one direction, relative to λ = |v|/Δx.
struct upstream {
  double here = 1.0,            ///< factor of δ itself
      first = 0.0,              ///< of the row `one`
      second = 0.0;             ///< of the row `two`
  const double *one = nullptr,  ///< δ in the cell upstream, or what enters
      *two = nullptr;           ///< in the next one
};

/// row ← the solution δ of (Σ_d λ_d here_d + rate) δ = row + Σ_d λ_d (first_d one_d + second_d two_d) for the
/// components of all strips; `lambda`: of every component, for 1 to 3 directions.
void solve(std::span<const upstream> terms, const std::array<const double*, 3>& lambda, double rate,
           std::span<const strip> strips, double* row);

}  // namespace sweep_rows
}  // namespace apsis
