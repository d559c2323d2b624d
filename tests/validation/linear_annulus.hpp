#pragma once

namespace validation_test {

/// Gas between coaxial cylinders of radii 1 and 2 with diffuse walls. The inner one turns slowly or is
/// slightly warmer. The steady linearized BGK equation is
///     c·∇φ = δ (ρ + 2 c·u + (c² − 3/2) τ − φ),   c = v/v₀, δ = p r₁/(μ v₀).
/// The solution uses neither mesh nor velocities of the library. On a straight ray to a point, φ is the
/// emission of its wall and the sources on its way, attenuated by exp(−δs/w) with the speed w in the plane.
/// Integrals over w are functions of δs. The moments are linear between graded radii and solve a dense
/// system. The error has about second order in 1/radii.
class linear_annulus {
 public:
  linear_annulus(double delta, int radii);

  /// Returns the torque on the rotating inner cylinder over its free-molecular value.
  double torque() const;
  /// Returns the heat from the warm inner cylinder over its free-molecular value.
  double heat() const;

 private:
  double delta_;
  int radii_;
};

}  // namespace validation_test
