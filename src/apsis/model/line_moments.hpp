#pragma once

namespace apsis {

/// Central moments, by direction, of an equilibrium g = ρ Π_k g_k(v_k), h = θ g. Moments of a polynomial
/// times the equilibrium follow from them. This header includes nothing, because kernels of devices use it.
struct line_moments {
  static constexpr decltype(sizeof 0) powers = 6;  ///< p = 0 … 5

  bool known = false;         ///< whether the rest is set
  double of[3][powers] = {};  ///< ⟨c_k^p⟩ per mass, c = v − u
  double others = 0.0;        ///< θ

  /// Sets the moments `of` to those of a Gaussian with temperature T.
  constexpr void set_gaussian(double T) {
    known = true;
    for (auto& one : of) {
      one[0] = 1.0;
      one[1] = one[3] = one[5] = 0.0;
      one[2] = T;
      one[4] = 3.0 * T * T;
    }
  }
};

}  // namespace apsis
