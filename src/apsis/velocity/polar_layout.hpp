#pragma once

#include <vector>

namespace apsis {

/// Velocities in cylindrical coordinates: rings of equal v_⊥ in the plane (v_r, v_θ), times points of v_x. A
/// ring has M angles ω_a = (a + ½) 2π/M with v_r = v_⊥ cos ω_a and v_θ = v_⊥ sin ω_a. Component (ring·M +
/// a)·apart + i of each set has angle a of this ring and point i of v_x. Dimensionless.
struct polar_layout {
  int rings = 0,   ///< number of rings; 0 if the velocities have no such layout
      angles = 0,  ///< M
      apart = 0;   ///< number of points of v_x, the distance between neighbouring angles in a row

  std::vector<double> speeds;  ///< v_⊥ of each ring

  /// Whether the velocities have no such layout.
  bool empty() const { return rings == 0; }
  /// Returns the number of velocities.
  int size() const { return rings * angles * apart; }
};

}  // namespace apsis
