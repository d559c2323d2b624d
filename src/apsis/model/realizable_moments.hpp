#pragma once

#include <apsis/model/maxwellian.hpp>

#include <array>
#include <cstddef>
#include <limits>
#include <optional>

namespace apsis {

/// Moments ω per mass of a row f ≥ 0, in the unit Δv of the grid, with their distances from the boundary of
/// the realizable set. With z = u/Δv the mean of |v|²/Δv² is at least Σ_k ℓ(z_k), ℓ being z² interpolated
/// linearly between neighbouring grid points, and at most Σ_k of the interpolation between the ends of a
/// direction, h² for ends ±h (docs/space.md).
struct realizable_moments {
  double rho = 0.0;                ///< mass; 0 is a vacuum, without the rest
  std::array<int, 3> nearest{};    ///< index of the grid point nearest to z_k
  std::array<double, 3> offset{};  ///< z_k less that point
  std::array<double, 3> z{};       ///< u_k/Δv, between the ends
  double square = 0.0;             ///< mean of |v|²/Δv²
  double above_least = 0.0;        ///< square − Σ_k ℓ(z_k) ≥ 0; 0 on the lower boundary
  double below_greatest = 0.0;     ///< greatest − square ≥ 0; 0 on the upper boundary
};

/// Returns the moments, projected onto the boundary if they lie outside by no more than the rounding error of
/// sums over the grid; nothing if ω is neither realizable nor close to it, or not finite. If ρ is so small
/// that moments are subnormal numbers or nearly so, their rounding errors have no bound relative to ρ, and
/// every finite ω is projected.
std::optional<realizable_moments> compute_realizable(const velocity_grid& grid, const double* omega);

}  // namespace apsis
