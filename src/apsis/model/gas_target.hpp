#pragma once

#include <apsis/model/formulas/target_moments.hpp>
#include <apsis/model/gas.hpp>
#include <apsis/model/line_moments.hpp>
#include <apsis/model/target_polynomial.hpp>

#include <array>
#include <functional>

namespace apsis {

/// Second and third moments about the bulk velocity, c = v − u. Dimensionless.
struct central_moments {
  std::array<std::array<double, 3>, 3> stress{};  ///< Θ_kl = Σ c_k c_l g Δv^d / ρ for resolved k, l
  std::array<double, 3> heat{};                   ///< q_k = ½ Σ c_k (|c|² g + h) Δv^d
};
/// Returns the central moments of a row with the density and bulk velocity of `state`.
central_moments compute_central_moments(const gas& of, const double* row, const fluid_state& state);

/// Returns central_moments::stress alone.
std::array<std::array<double, 3>, 3> compute_stress(const gas& of, const double* row,
                                                    const fluid_state& state);

using scalar::target_accuracy;

/// The row that a polynomial multiplies to give a target.
struct target_base {
  const double* row;     ///< g, or (g, h)
  line_moments moments;  ///< moments of the row, if known
  double others = 0.0;   ///< h/g, if the moments are unknown and h/g is a known constant; else 0
  std::function<void(double*)> fill = {};  ///< writes the row again, if it is that of the target
};

/// e ← max(base · P, −keep f) for a row f ≥ 0 and the polynomial P of `shape`. P is corrected by α + β·c +
/// γ|c|² in g until e has the moments ω. Combinations of f and e are then conservative, and nonnegative even
/// where P is negative in the tails. Sets `raised` if a value was raised to its bound. The row e may be that
/// of the base if the base can write it again. Returns false, with e undefined, if the corrections fail.
bool conservative_target(const gas& of, const double* omega, const target_base& base,
                         const target_shape& shape, const double* f, double keep, double* e, bool& raised);

}  // namespace apsis
