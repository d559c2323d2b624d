#pragma once

#include <cstddef>

namespace apsis {

/// Losses of a force at the ends of the velocities and by limited fluxes, among the amounts of a
/// boundary_budget. The layout is, with N invariants of a gas:
///     held       mass that entered the last velocities in the direction of the force and cannot leave them
///     lost       ∫(ρa − given) of the N − 2 components of the momentum, ∫(ρu·a − given) of the energy
///     drive      ∫ρ|a|
struct force_losses {
  static constexpr std::size_t held = 0;  ///< place of the mass
  static constexpr std::size_t lost = 1;  ///< place of the first component of the momentum
  /// Returns the number of amounts; the last one is the drive.
  static constexpr std::size_t size(std::size_t invariants) { return invariants + 1; }
};

}  // namespace apsis
