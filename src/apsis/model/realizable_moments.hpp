#pragma once

#include <apsis/model/maxwellian.hpp>

#include <array>
#include <cstddef>
#include <limits>
#include <optional>

namespace apsis {

/// Moments ω per mass of a row f ≥ 0, in the unit Δv of the grid, with their distances from the boundary of
/// the realizable set. Let z = u/Δv, and let ℓ interpolate z² linearly between neighbouring grid points. The
/// mean of |v|²/Δv² is at least Σ_k ℓ(z_k). At most it is Σ_k of the linear interpolation of z² between the
/// ends of direction k, which is h² for ends ±h (docs/space.md).
struct realizable_moments {
  double rho = 0.0;                ///< mass; 0 for a vacuum, where the other members are not set
  std::array<int, 3> nearest{};    ///< index of the grid point nearest to z_k
  std::array<double, 3> offset{};  ///< z_k minus that point
  std::array<double, 3> z{};       ///< u_k/Δv, between the ends
  double square = 0.0;             ///< mean of |v|²/Δv²
  double above_least = 0.0;        ///< square − Σ_k ℓ(z_k) ≥ 0; 0 on the lower boundary
  double below_greatest = 0.0;     ///< greatest − square ≥ 0; 0 on the upper boundary
};

/// Returns the moments per mass. Moments that lie outside by no more than the rounding error of sums over the
/// grid are projected onto the boundary. Returns nothing if ω lies farther outside or is not finite. If ρ is
/// so small that moments are nearly subnormal numbers, their rounding errors have no bound relative to ρ.
/// Every finite ω is then projected.
std::optional<realizable_moments> compute_realizable(const velocity_grid& grid, const double* omega);

}  // namespace apsis
