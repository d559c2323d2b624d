#pragma once

namespace validation_test {

/// Gas in a long duct of rectangular cross-section with diffuse walls, driven along z by a small gradient of
/// pressure or temperature. The steady linearized BGK equation
///     c·∇Z = δ (u − Z) + source,   u = ⟨Z⟩,
/// holds for the part Z c_z of the perturbation. Z vanishes for molecules that leave a wall. δ = pL/(μ v₀)
/// with the shorter side L, which is 1. The flow rates are G = 2 (mean of u), in units of v₀/2 times the
/// relative gradient. Their error by Galerkin's method is that of u squared.
class linear_duct {
 public:
  /// `aspect` ≥ 1 is the longer side, `n` the number of polynomials in each direction.
  linear_duct(double delta, double aspect, int n);

  /// Returns G for a pressure gradient, source 1/2.
  double flow() const { return flow_; }
  /// Returns G for a temperature gradient, source (1 − c²)/2, towards the hot end.
  double creep() const { return creep_; }

 private:
  double flow_ = 0.0, creep_ = 0.0;
};

}  // namespace validation_test
