#pragma once

#include <apsis/method/golden_section.hpp>
#include <apsis/method/tableau.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace apsis {

/// O(ε) terms, for ε ≪ Δt, of a method of type A or ARS applied to u' = T(u) + C(E(ω) − u)/ε, ω = ℛu
/// (docs/plateaus.md). The exact solution deviates from equilibrium by D = E(ω) − u, of size ε; stage i
/// deviates by χ_i D. To leading order in ε and Δt the numerical ω obeys
///   ω_t = ℛT(E) − flux · ℛT′(E) D,    exact: flux = 1.
/// The numerical initial layer shifts ω by `layer` times the shift due to the exact layer. The result u^{n+1}
/// deviates from equilibrium by last · D. The O(ε) part of the error vanishes for data near equilibrium if
/// flux = last = 1, and for any data if, in addition, layer = 1. The remaining members are the coefficients
/// of the terms of size εΔt. Each belongs to one elementary differential of f = ℛT(E), g = E′f − T(E) and Ψ =
/// ℛT′(E)/C. Dimensionless.
template <class Real>
struct intermediate_regime {
  bool applies = false;  ///< whether every stage has d ≠ 0 or ḋ ≠ 0, or is u^n itself
  std::vector<Real>
      kept;      ///< χ_i = (Σ_j w_ij/r − Σ_{j<i} d_ij χ_j)/d_ii; 0 where ḋ_i ≠ 0; χ_s where u_i = u^n
  Real flux{};   ///< Σ_i b̂_i χ_i
  Real last{};   ///< χ_s
  Real layer{};  ///< Σ_i b̂_i λ_i, λ_i defined like χ_i with r_i in place of Σ_j w_ij/r; infinite where u^n
                 ///< is a stage

  Real flux_place{};      ///< Σ b̂_i ĉ_i χ_i, coefficient of (Ψ′f) g; exact: 1/2
  Real flux_slope{};      ///< Σ b̂_i χ′_i, coefficient of Ψ g′f, χ′ defined like χ with RÂĉ; exact: 1/2
  Real flux_curvature{};  ///< Σ b̂_i χ″_i, coefficient of Ψ E″(f, f), including its part of g′f, χ″ with
                          ///< Rĉ²/2; exact: 1/2
  Real flux_carried{};    ///< Σ b̂_i â_ij χ_j, coefficient of f′Ψ g; exact: 1/2
  Real last_slope{};      ///< χ′_s, coefficient of g′f; exact: 1
  Real last_curvature{};  ///< χ″_s, coefficient of E″(f, f); exact: 1
  Real layer_place{};     ///< Σ b̂_i ĉ_i λ_i, coefficient of (Ψ′f) D₀; exact: 0
  Real layer_carried{};   ///< Σ b̂_i â_ij λ_j, coefficient of f′Ψ D₀; exact: 1
};

/// Solves the stage equations in the limit z = CΔt/ε → ∞: Σ_{j≤i} d_ij x_j = source_i for stages with ḋ_i =
/// 0, and x_i = 0 where ḋ_i ≠ 0.
template <class Real>
class relaxed_stages {
 public:
  /// Stores a reference to m, which must outlive this object.
  explicit relaxed_stages(const shu_osher_form<Real>& m) : m_(m) {
    const auto initial = initial_weights(m);
    for (std::size_t i = 0; i < m.stages(); ++i) {
      const bool relaxed = m.ddot[i] != Real(0) || m.D(i, i) != Real(0);
      bool is_start = !relaxed && initial[i] == Real(1);
      for (std::size_t j = 0; j < i; ++j)
        is_start = is_start && m.P(i, j) == Real(0) && m.W(i, j) == Real(0) && m.D(i, j) == Real(0);
      start_.push_back(is_start);
      has_start_ = has_start_ || start_.back();
      solvable_ = solvable_ && (relaxed || start_.back());
    }
    if (!solvable_) return;
    of_start_ = solve(std::vector<Real>(m.stages()), Real(1));
    solvable_ = of_start_.back() != Real(1);
  }

  /// Whether every stage is relaxed or u^n itself, and the last one is not u^n.
  bool solvable() const { return solvable_; }
  /// Whether some stage is u^n itself.
  bool has_start() const { return has_start_; }

  /// Returns x. A stage that is u^n itself has the value x_s − shift, that of the last stage of
  /// the previous step.
  std::vector<Real> operator()(const std::vector<Real>& source, const Real& shift) const {
    auto x = solve(source, Real(0));
    const Real start = (x.back() - shift) / (Real(1) - of_start_.back());
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += of_start_[i] * start;
    return x;
  }

 private:
  std::vector<Real> solve(const std::vector<Real>& source, const Real& start) const {
    std::vector<Real> x(m_.stages());
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (start_[i]) x[i] = start;
      if (start_[i] || m_.ddot[i] != Real(0)) continue;
      Real sum = source[i];
      for (std::size_t j = 0; j < i; ++j) sum -= m_.D(i, j) * x[j];
      x[i] = sum / m_.D(i, i);
    }
    return x;
  }

  const shu_osher_form<Real>& m_;
  std::vector<bool> start_;
  std::vector<Real> of_start_;
  bool has_start_ = false, solvable_ = true;
};

/// Computes the coefficients from the Shu–Osher form. A stage that is u^n itself has the deviation D of the
/// last stage of the previous step. If the regime does not apply, only `applies` is set.
template <class Real>
intermediate_regime<Real> analyse_intermediate_regime(const shu_osher_form<Real>& m) {
  intermediate_regime<Real> out;
  const relaxed_stages<Real> relax(m);
  out.applies = relax.solvable();
  if (!out.applies) return out;
  const std::size_t s = m.stages();
  const auto A_hat = to_butcher(m).A_hat;
  const auto weighted = [&](const std::vector<Real>& x) { return (A_hat * x).back(); };
  const auto product = [s](std::vector<Real> x, const std::vector<Real>& y) {
    for (std::size_t i = 0; i < s; ++i) x[i] *= y[i];
    return x;
  };
  const auto c = A_hat * std::vector<Real>(s, Real(1));

  // Right-hand sides Rĉ = We/r, RÂĉ = Wĉ/r and Rĉ²/2.
  auto moved = m.W * std::vector<Real>(s, Real(1)), slope = m.W * c, curvature = product(c, c);
  const auto of_P = m.P * curvature, of_W = m.W * curvature;
  for (std::size_t i = 0; i < s; ++i) {
    moved[i] /= m.r;
    slope[i] /= m.r;
    curvature[i] = (curvature[i] - of_P[i] - of_W[i]) / Real(2);
  }
  out.kept = relax(moved, Real(0));
  out.flux = weighted(out.kept);
  out.last = out.kept.back();
  const auto slopes = relax(slope, out.last), curvatures = relax(curvature, out.last);
  out.flux_place = weighted(product(c, out.kept));
  out.flux_slope = weighted(slopes);
  out.flux_curvature = weighted(curvatures);
  out.flux_carried = weighted(A_hat * out.kept);
  out.last_slope = slopes.back();
  out.last_curvature = curvatures.back();

  out.layer = out.layer_place = out.layer_carried = std::numeric_limits<Real>::infinity();
  if (relax.has_start()) return out;
  const auto seen = relax(initial_weights(m), Real(0));
  out.layer = weighted(seen);
  out.layer_place = weighted(product(c, seen));
  out.layer_carried = weighted(A_hat * seen);
  return out;
}

/// flux and last of intermediate_regime at finite z = CΔt/ε, and one step of an initial layer.
template <class Real>
struct finite_rate {
  Real flux{},  ///< Σ b̂_i κ_i(z)
      last{},   ///< κ_s(z)
      layer{},  ///< Σ b̂_i λ_i(z); exact: (1 − e^{−z})/z
      decay{};  ///< λ_s(z) = R(−z); exact: e^{−z}
};

/// Computes flux, last, layer and decay at finite z > 0, for methods of any type. Stage i deviates from
/// equilibrium by κ_i(z) times the exact deviation, where
///   (I + zA − z²Ȧ) κ = z ĉ + κ_s e,    flux(z) = Σ b̂_i κ_i,    last(z) = κ_s.
/// For Δt → 0 with z fixed, the numerical ω obeys ω_t = ℛT(E) − flux(z) ℛT′(E) D. flux and last tend to 1 as
/// z → 0 and to the values of intermediate_regime as z → ∞. A deviation D₀ left from the initial layer is λ_i
/// D₀ in stage i, with (I + zA − z²Ȧ) λ = e. The step changes ω by −Δt layer(z) ℛT′(E) D₀ and leaves decay(z)
/// D₀.
template <class Real>
finite_rate<Real> at_finite_rate(const butcher_form<Real>& b, const Real& z) {
  const std::size_t s = b.stages();
  std::vector<Real> c(s), moved(s), of_start(s);
  for (std::size_t i = 0; i < s; ++i) {
    Real sum(0), start(1);
    for (std::size_t j = 0; j < i; ++j) {
      const Real coupling = z * (b.A(i, j) - z * b.A_dot(i, j));
      c[i] += b.A_hat(i, j);
      sum -= coupling * moved[j];
      start -= coupling * of_start[j];
    }
    const Real diagonal = Real(1) + z * (b.A(i, i) - z * b.A_dot(i, i));
    moved[i] = (sum + z * c[i]) / diagonal;
    of_start[i] = start / diagonal;
  }
  finite_rate<Real> out;
  out.decay = of_start[s - 1];
  out.last = moved[s - 1] / (Real(1) - out.decay);
  for (std::size_t i = 0; i < s; ++i) {
    out.flux += b.A_hat(s - 1, i) * (moved[i] + of_start[i] * out.last);
    out.layer += b.A_hat(s - 1, i) * of_start[i];
  }
  return out;
}

/// Maximum of |flux(z) − 1|/z over z. As ε and Δt tend to 0 at a fixed ratio, the error of the O(ε) term is
/// at most `error`·Δt. It attains this bound for ε/C = Δt/at.
struct intermediate_band {
  double error = 0.0,  ///< max |flux(z) − 1|/z
      at = 0.0;        ///< location z of the maximum
};

/// Maximizes |excess(z)|/z, excess = flux − 1, over 10⁻³ ≤ z ≤ 10⁵. Samples at 40 points per decade and
/// refines every local maximum by golden section. Returns a NaN error if a sample is NaN.
template <class Excess>
intermediate_band compute_band_of(const Excess& excess) {
  constexpr int per_decade = 40, first = -3 * per_decade, last = 5 * per_decade;
  const auto z_of = [](double k) { return std::pow(10.0, k / per_decade); };
  const auto error = [&](double k) {
    const double z = z_of(k);
    return std::abs(excess(z)) / z;
  };
  std::vector<double> errors;
  for (int k = first; k <= last; ++k) {
    errors.push_back(error(k));
    if (std::isnan(errors.back())) return {errors.back(), z_of(k)};
  }
  intermediate_band band;
  for (std::size_t k = 0; k < errors.size(); ++k) {
    const bool rises = k == 0 || errors[k] >= errors[k - 1];
    const bool falls = k + 1 == errors.size() || errors[k] >= errors[k + 1];
    if (!rises || !falls) continue;
    const double place = first + static_cast<double>(k);
    const auto peak =
        golden_section(error, std::max<double>(place - 1, first), std::min<double>(place + 1, last), 40);
    if (errors[k] > band.error) band = {errors[k], z_of(place)};
    if (peak.value > band.error) band = {peak.value, z_of(peak.at)};
  }
  return band;
}

/// Returns the band of a method of one step.
template <class Real>
intermediate_band compute_intermediate_band(const butcher_form<Real>& b) {
  return compute_band_of(
      [&b](double z) { return static_cast<double>(at_finite_rate(b, Real(z)).flux - Real(1)); });
}

}  // namespace apsis
