#pragma once

#include <apsis/velocity/position.hpp>

#include <array>

namespace apsis {

/// Cosine and sine of an angle.
struct angle_functions {
  double cosine = 1.0;  ///< of the angle
  double sine = 0.0;    ///< of the angle
};

/// Returns cosine and sine of an angle in degrees, exactly 0, 1 or −1 at multiples of 90°.
angle_functions functions_of_degrees(double degrees);

/// A rotation R of space about an axis through the origin.
class rotation {
 public:
  /// Makes the identity.
  rotation() = default;
  /// R = c I + (1 − c) a aᵀ + s [a]× for a unit vector a, where c and s are cosine and sine of the angle
  /// (Rodrigues' formula). R has no rounding errors at multiples of 90° about coordinate axes.
  rotation(const position& unit_axis, double degrees);

  position apply(const position& x) const;          ///< returns R x
  position apply_inverse(const position& x) const;  ///< returns Rᵀ x
  bool is_identity() const;                         ///< whether R = I exactly

 private:
  std::array<position, 3> rows_ = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
};

}  // namespace apsis
