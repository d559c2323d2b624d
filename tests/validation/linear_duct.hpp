#pragma once

namespace validation_test {

/// Gas in a long duct of rectangular cross-section with diffuse walls, driven along z by a small gradient of
/// pressure or temperature: the steady linearized BGK equation
///     c·∇Z = δ (u − Z) + source,   u = ⟨Z⟩,
/// for the part Z c_z of the perturbation, which vanishes for molecules that leave a wall. δ = pL/(μ v₀) with
/// the shorter side L, which is 1. The flow rates are G = 2 (mean of u), in units of v₀/2 times the relative
/// gradient, and the error of Galerkin's method is that of u squared.
class linear_duct {
 public:
  /// aspect ≥ 1: the longer side; n polynomials in each direction.
  linear_duct(double delta, double aspect, int n);

  /// Returns G of a pressure gradient, source 1/2.
  double flow() const { return flow_; }
  /// Returns G of a temperature gradient, source (1 − c²)/2, towards the hot end.
  double creep() const { return creep_; }

 private:
  double flow_ = 0.0, creep_ = 0.0;
};

}  // namespace validation_test
