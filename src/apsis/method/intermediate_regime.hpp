#pragma once

#include <apsis/method/tableau.hpp>

#include <limits>
#include <vector>

namespace apsis {

/// What a method of type A or ARS makes of the terms of size ε of u' = T(u) + C(E(ω) − u)/ε, ω = ℛu, when
/// ε ≪ Δt (docs/plateaus.md). The exact solution differs from equilibrium by D = E(ω) − u, of size ε, stage i
/// by χ_i D. To leading order in ε and Δt the numerical ω obeys
///   ω_t = ℛT(E) − flux · ℛT′(E) D,    exact: flux = 1,
/// its initial layer moves it by `layer` times what the exact layer does, and the result has the deviation
/// last · D. The O(ε) part of the error vanishes for data near equilibrium if flux = last = 1, and for any
/// data if layer = 1. Dimensionless.
template <class Real>
struct intermediate_regime {
  bool applies = false;  ///< every stage has d ≠ 0 or ḋ ≠ 0, or is u^n itself
  std::vector<Real>
      kept;      ///< χ_i = (Σ_j w_ij/r − Σ_{j<i} d_ij χ_j)/d_ii; 0 where ḋ_i ≠ 0; χ_s where u_i = u^n
  Real flux{};   ///< Σ_i b̂_i χ_i
  Real last{};   ///< χ_s
  Real layer{};  ///< Σ_i b̂_i λ_i, λ_i like χ_i with r_i for Σ_j w_ij/r; infinite where u^n is a stage
};

/// From the Shu–Osher form. Where u^n itself is a stage, it has the D of the last stage of the step before.
template <class Real>
intermediate_regime<Real> analyse_intermediate_regime(const shu_osher_form<Real>& m) {
  const std::size_t s = m.stages();
  const auto initial = initial_weights(m);
  // Solutions of Σ_j d_ij x_j = source_i, with x_i = 0 where ḋ_i ≠ 0; x_i of a stage u^n is given.
  std::vector<Real> kept(s), of_start(s), layer(s);
  bool has_start = false;
  for (std::size_t i = 0; i < s; ++i) {
    if (m.ddot[i] != Real(0)) continue;
    Real transported(0), started(0), from_start = initial[i];
    for (std::size_t j = 0; j < i; ++j) {
      transported += m.W(i, j) / m.r - m.D(i, j) * kept[j];
      started -= m.D(i, j) * of_start[j];
      from_start -= m.D(i, j) * layer[j];
    }
    if (m.D(i, i) != Real(0)) {
      kept[i] = transported / m.D(i, i);
      of_start[i] = started / m.D(i, i);
      layer[i] = from_start / m.D(i, i);
    } else if (initial[i] == Real(1)) {
      of_start[i] = Real(1);
      has_start = true;
    } else {
      return {};
    }
  }
  intermediate_regime<Real> out;
  out.applies = of_start[s - 1] != Real(1);
  if (!out.applies) return out;
  out.last = kept[s - 1] / (Real(1) - of_start[s - 1]);
  const auto butcher = to_butcher(m);
  for (std::size_t i = 0; i < s; ++i) {
    out.kept.push_back(kept[i] + of_start[i] * out.last);
    out.flux += butcher.A_hat(s - 1, i) * out.kept[i];
    out.layer += butcher.A_hat(s - 1, i) * layer[i];
  }
  if (has_start) out.layer = std::numeric_limits<Real>::infinity();
  return out;
}

}  // namespace apsis
