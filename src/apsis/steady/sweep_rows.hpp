#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace apsis {

/// The implicit upwind equations of one cell, for the instruction set of this processor.
namespace sweep_rows {

/// A range of consecutive components.
struct strip {
  int begin = 0,     ///< first component
      end = 0,       ///< component after the last one
      upstream = 0;  ///< distance to the components from which a rotation flows into the range
};

/// The terms of one direction, relative to λ = |v|/Δx.
struct upstream {
  double here = 1.0,            ///< factor of δ itself
      first = 0.0,              ///< factor of the row `one`
      second = 0.0;             ///< factor of the row `two`
  const double *one = nullptr,  ///< δ in the next cell upstream, or the entering δ
      *two = nullptr;           ///< δ in the cell after that
};

/// Rotation of rings of velocities, of first order. An empty one has no arrays.
struct rotation {
  const double *out = nullptr,  ///< rate of outflow of every component at the radius 1
      *in = nullptr;            ///< the same of inflow
  double per_radius = 1.0;      ///< 1/r
};

/// row ← the solution δ of (Σ_d λ_d here_d + rate) δ = row + Σ_d λ_d (first_d one_d + second_d two_d) for the
/// components of all strips, in order. lambda[d] has λ_d of every component, for 1 to 3 directions. A
/// rotation adds (out/r) δ on the left, and in/r times the δ upstream on the right. A strip follows the one
/// upstream.
void solve(std::span<const upstream> terms, const std::array<const double*, 3>& lambda, double rate,
           const rotation& turn, std::span<const strip> strips, double* row);

}  // namespace sweep_rows
}  // namespace apsis
