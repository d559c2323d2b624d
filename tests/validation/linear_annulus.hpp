#pragma once

namespace validation_test {

/// Gas between coaxial cylinders of radii 1 and 2 with diffuse walls, the inner one turning slowly or
/// slightly warmer: the steady linearized BGK equation
///     c·∇φ = δ (ρ + 2 c·u + (c² − 3/2) τ − φ),   c = v/v₀, δ = p r₁/(μ v₀),
/// without mesh or velocities of the library. Along a straight ray that arrives at a point, φ is what its
/// wall emits and the sources on its way, weakened by exp(−δs/w) with the speed w in the plane. Integrals
/// over w are functions of δs. The moments at graded radii, between which they are linear, solve a dense
/// system. The error has about second order in 1/radii.
class linear_annulus {
 public:
  linear_annulus(double delta, int radii);

  /// Returns the torque on the turning inner cylinder over its free-molecular value.
  double torque() const;
  /// Returns the heat from the warm inner cylinder over its free-molecular value.
  double heat() const;

 private:
  double delta_;
  int radii_;
};

}  // namespace validation_test
