#pragma once

#include <array>
#include <cstddef>

namespace apsis {

/// Central moments, by direction, of an equilibrium g = ρ Π_k g_k(v_k), h = θ g. They give the moments of
/// polynomials times it.
struct line_moments {
  static constexpr std::size_t powers = 6;  ///< p = 0 … 5

  bool known = false;                                 ///< whether the rest is set
  std::array<std::array<double, powers>, 3> of = {};  ///< ⟨c_k^p⟩ per mass, c = v − u
  double others = 0.0;                                ///< θ

  /// Sets those of a Gaussian of temperature T.
  void set_gaussian(double T) {
    known = true;
    for (auto& one : of) one = {1.0, 0.0, T, 0.0, 3.0 * T * T, 0.0};
  }
};

}  // namespace apsis
