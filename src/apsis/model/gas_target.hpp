#pragma once

#include <apsis/model/formulas/target_moments.hpp>
#include <apsis/model/gas.hpp>
#include <apsis/model/line_moments.hpp>

#include <array>

namespace apsis {

/// Second and third moments about the bulk velocity.
struct central_moments {
  std::array<std::array<double, 3>, 3> stress{};  ///< Θ_kl = Σ c_k c_l g Δv^d / ρ for resolved k, l
  std::array<double, 3> heat{};                   ///< q_k = ½ Σ c_k (|c|² g + h) Δv^d
};
/// Returns those of a row whose density and bulk velocity are given.
central_moments compute_central_moments(const gas& of, const double* row, const fluid_state& state);

/// Returns the second ones alone.
std::array<std::array<double, 3>, 3> compute_stress(const gas& of, const double* row,
                                                    const fluid_state& state);

using scalar::target_accuracy, scalar::target_polynomial, scalar::target_shape;

/// The row that a target is a polynomial times.
struct target_base {
  const double* row;     ///< g, or (g, h)
  line_moments moments;  ///< those of the row, if known
  double others = 0.0;   ///< h/g, if the moments are unknown and h/g is a known constant; else 0
};

/// e ← max(base · P, −keep f) for a row f ≥ 0, where P is corrected by α + β·c + γ|c|² in g until e has the
/// moments ω: a combination of f and e stays nonnegative and conservative, also where P is negative in the
/// tails. Sets `raised` where a value was raised to its bound. Returns false if e is not found; it is then
/// undefined.
bool conservative_target(const gas& of, const double* omega, const target_base& base,
                         const target_shape& shape, const double* f, double keep, double* e, bool& raised);

}  // namespace apsis
