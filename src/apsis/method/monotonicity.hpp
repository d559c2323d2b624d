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

/// Analyses whether a method belongs to the paper's class. With the diagonals d_j and ḋ_j of A and Ȧ, column
/// j of R⁻¹ is A_·j/d_j or Ȧ_·j/ḋ_j, so that R is unique. The class requires Re ≥ 0, RÂ ≥ 0, R_ij ≤ 0 for j <
/// i, and diagonal RA ≥ 0 and RȦ ≤ 0. Then r = min −R_ij/(RÂ)_ij over (RÂ)_ij > 0. A stage that is u^n itself
/// is merged with u^n. The last row may be an explicit update without implicit part. Entries below `zero`
/// count as 0.
ssp_analysis analyse_imex(const butcher_form<mp_real>& b, const mp_real& zero);

/// Returns R of that class without a check of signs. If A and Ȧ do not determine R, returns nothing and sets
/// `reason` to the offending entry. If a stage is u^n itself, it carries the weight of u^n in later rows.
std::optional<matrix<mp_real>> stage_matrix(const butcher_form<mp_real>& b, const mp_real& zero,
                                            std::string& reason);

/// Computes the radius of absolute monotonicity of a tableau K whose last row is the update (Kraaijevanger,
/// BIT 31, 1991): the largest r with K(I + rK)⁻¹ ≥ 0 and (I + rK)⁻¹ e ≥ 0. It is the SSP coefficient of an
/// explicit method. It is also that of a DIRK method if the property is known for forward Euler steps of Q
/// only. A correct `guess` (from below, to within 10⁶·zero) saves the bisection.
mp_real monotonicity_radius(const matrix<mp_real>& tableau, const mp_real& zero,
                            const mp_real& guess = mp_real(0));

}  // namespace apsis
