#pragma once

#include "rectangle_flights.hpp"

#include <array>

namespace validation_test {

/// The steady linearized BGK equation in the unit square,
///     c·∇φ = δ (ρ + 2 c·u + (c² − 3/2) τ − φ),   c = v/v₀ in three dimensions, δ = pL/(μ v₀),
/// with diffuse sides. The top moves along itself or is hotter than the others. Galerkin's method solves for
/// the moments ρ, u and τ inside, and for the density of the molecules that leave each side. At the ends of
/// the top the moments depend on the direction from there, so their error is of second order in 1/n. Drag and
/// heat are quadratic in it, so their error is of about fourth order.
class linear_square {
 public:
  /// `n` is the number of polynomials in each direction.
  linear_square(double delta, int n);

  /// Returns the shear force on the top that moves with U, over ρ U √(RT/(2π)), the momentum with which
  /// molecules leave it.
  double drag() const { return drag_; }
  /// Returns the heat that a side receives from the hot top, over the heat with which molecules
  /// leave the top.
  double heat(side of) const { return heat_[static_cast<std::size_t>(of)]; }

 private:
  double drag_ = 0.0;
  std::array<double, 4> heat_{};
};

}  // namespace validation_test
