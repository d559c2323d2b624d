#pragma once

#include <apsis/method/precision.hpp>
#include <apsis/method/tableau.hpp>

#include <optional>
#include <string>

namespace apsis {

/// Strong stability of a method, derived from its Butcher form alone. Indices in `forbids` count from 1.
struct ssp_analysis {
  bool exists = false;         ///< whether a Shu–Osher form with the signs of the paper's theorems exists
  bool unconditional = false;  ///< no step bound from Q (the form exists)
  bool bounded = true;         ///< the transport limits the step (W ≠ 0)
  mp_real coefficient = 0;     ///< r; 0 if none exists, undefined if !bounded
  std::string forbids;         ///< the entry that limits r, or rules out every r > 0
};

/// Analyses the paper's class: with d_j, ḋ_j the diagonals, column j of R⁻¹ is A_·j/d_j or Ȧ_·j/ḋ_j, so R is
/// unique, and r = min −R_ij/(RÂ)_ij over (RÂ)_ij > 0, if Re ≥ 0, RÂ ≥ 0, and RA and RȦ are diagonal with
/// signs ≥ 0 and ≤ 0. A first stage that is u^n itself is merged with u^n; the last row needs no implicit
/// part (an explicit update u^{n+1}). Entries below `zero` count as 0.
ssp_analysis analyse_imex(const butcher_form<mp_real>& b, const mp_real& zero);

/// Returns R of that class, or nothing, with the offending entry in `reason`, if the method is not in the
/// class. If a stage is u^n itself, it carries the weight of u^n in all rows.
std::optional<matrix<mp_real>> stage_matrix(const butcher_form<mp_real>& b, const mp_real& zero,
                                            std::string& reason);

/// Computes the radius of absolute monotonicity of a tableau K whose last row is the update (Kraaijevanger,
/// BIT 31, 1991): the largest r with K(I + rK)⁻¹ ≥ 0 and (I + rK)⁻¹ e ≥ 0. It is the SSP coefficient of an
/// explicit method, and of a DIRK method if the property is known for forward Euler steps of Q only. A
/// correct `guess` (from below, to within 10⁶·zero) saves the bisection.
mp_real monotonicity_radius(const matrix<mp_real>& tableau, const mp_real& zero,
                            const mp_real& guess = mp_real(0));

}  // namespace apsis
