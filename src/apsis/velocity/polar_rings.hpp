#pragma once

#include <apsis/velocity/polar_layout.hpp>

#include <vector>

namespace apsis {

/// Velocities across an axis, (v_⊥ cos ω, v_⊥ sin ω), with weights for ∫ f v_⊥ dv_⊥ dω. v_⊥ = max s² at the
/// midpoints s of equal intervals of [0, 1], and ω takes the midpoints of equal intervals of [0, 2π]. The
/// integrand in s begins with s³, so that the midpoint rule has fourth order for f smooth in v_⊥. It is
/// spectrally accurate for f smooth in ω. Images under reflection at both axes and under rotation by 90° have
/// equal bits. Dimensionless.
class polar_rings {
 public:
  /// Throws input_error unless rings ≥ 4, angles ≥ 12, angles is a multiple of 4, and 0 < max < ∞.
  polar_rings(int rings, int angles, double max);

  /// Returns the layout of the products of these velocities with `axial` velocities along the axis.
  polar_layout layout(int axial) const { return {rings_, angles_, axial, speeds_}; }
  int rings() const { return rings_; }    ///< number of rings
  int angles() const { return angles_; }  ///< number of angles of a ring
  double speed(int ring) const { return speeds_[static_cast<std::size_t>(ring)]; }  ///< v_⊥
  double weight(int ring) const {
    return weights_[static_cast<std::size_t>(ring)];
  }  ///< of each of its points
  /// Returns cos ω_a for any integer a. sin ω_a is cosine(a − angles()/4).
  double cosine(int angle) const;

 private:
  int rings_, angles_;
  std::vector<double> speeds_, weights_, quarter_;  ///< quarter_: cosines between 0 and π/2
};

}  // namespace apsis
