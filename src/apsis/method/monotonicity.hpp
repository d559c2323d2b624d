#pragma once

#include <apsis/method/precision.hpp>
#include <apsis/method/tableau.hpp>

#include <optional>
#include <string>

namespace apsis {

/// What a Butcher form alone says about strong stability. Indices in `forbids` count from 1.
struct ssp_analysis {
  bool exists = false;         ///< a Shu–Osher form with the signs of the paper's theorems
  bool unconditional = false;  ///< no bound on Δt from Q (the form exists)
  bool bounded = true;         ///< the transport sets a bound (W ≠ 0)
  mp_real coefficient = 0;     ///< r, 0 if none exists; meaningless where !bounded
  std::string forbids;         ///< the entry that forbids a larger r, or any
};

/// The paper's class: with d_j, ḋ_j the diagonals, column j of R⁻¹ is A_·j/d_j or Ȧ_·j/ḋ_j, so R is unique,
/// and r = min −R_ij/(RÂ)_ij over (RÂ)_ij > 0, if Re ≥ 0, RÂ ≥ 0, RA and RȦ are diagonal with signs ≥ 0 and ≤
/// 0. A first stage that is u^n itself is merged with u^n; the last row needs no implicit part (an update
/// u^{n+1} that is no stage). Entries below `zero` count as 0.
ssp_analysis analyse_imex(const butcher_form<mp_real>& b, const mp_real& zero);

/// The R of that class, if there is one; else nothing, and in `reason` the entry that forbids it. Where a
/// stage is u^n itself, it carries the weight of u^n in all rows.
std::optional<matrix<mp_real>> stage_matrix(const butcher_form<mp_real>& b, const mp_real& zero,
                                            std::string& reason);

/// Radius of absolute monotonicity of one tableau K whose last row is the update (Kraaijevanger, BIT 31,
/// 1991): the largest r with K(I + rK)⁻¹ ≥ 0 and (I + rK)⁻¹ e ≥ 0. The SSP coefficient of an explicit method,
/// and of a DIRK method when only forward Euler steps of Q keep the property. A `guess` that is right (from
/// below, to 10⁶ zeros) saves the bisection.
mp_real monotonicity_radius(const matrix<mp_real>& tableau, const mp_real& zero,
                            const mp_real& guess = mp_real(0));

}  // namespace apsis
