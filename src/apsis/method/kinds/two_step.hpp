#pragma once

#include <apsis/method/intermediate_regime.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/precision.hpp>
#include <apsis/method/trees.hpp>

#include <string>
#include <vector>

namespace apsis {

// A two-step method with equal steps is a Shu–Osher form of s + 1 rows. The first row stands for u_0 =
// u^{n−1}. For i = 1 … s,
//   u_i = r_i u^n + Σ_{j<i} p_ij u_j + Σ_{j<i} w_ij (u_j + (Δt/r) T(u_j)) + Δt d_i Q(u_i) + Δt² ḋ_i Q̇(u_i),
//   r_i = 1 − Σ_j (p_ij + w_ij),    u^{n+1} = u_s.
// If all weights and d_i are ≥ 0 and ḋ_i ≤ 0, the method preserves convex properties of u^{n−1} and u^n for
// Δt ≤ r Δt_FE: those that forward Euler steps of T and stage solves preserve. Multi-derivative general
// linear methods of this form are not in the paper. Dimensionless.

/// Computes the last entries φ_s(τ) of the stage vectors of order_conditions.hpp, with φ_0(τ) =
/// (−1)^{|τ|}/γ(τ), the value of the exact solution at t_n − Δt. The method has order p if φ_s(τ) = 1/γ(τ)
/// for |τ| ≤ p.
template <class Real>
std::vector<Real> two_step_weights(const shu_osher_form<Real>& m, const std::vector<rooted_tree>& trees);

/// flux and last of docs/plateaus.md for a two-step method.
template <class Real>
struct two_step_rate {
  Real flux{},  ///< rate of change of a moment due to the deviation from equilibrium, relative to the exact
                ///< one
      last{};   ///< deviation from equilibrium after a step, relative to the exact one
};

/// Computes flux(z) and last(z) at finite z = CΔt/ε > 0, where u^{n−1} and u^n deviate from equilibrium by
/// last(z) times the exact deviation.
template <class Real>
two_step_rate<Real> two_step_at_finite_rate(const shu_osher_form<Real>& m, const Real& z);

/// Returns the weight b of u^{n−1} in u^{n+1} for T = Q = 0; the roots of the method are 1 and −b.
template <class Real>
Real weight_of_previous(const shu_osher_form<Real>& m);

/// Properties of a two-step method, derived from its coefficients.
struct two_step_certificate {
  std::string name;         ///< name of the method
  int order = 0;            ///< order p by the order conditions
  int conditions = 0;       ///< number of conditions up to order p
  mp_real order_residual;   ///< largest residual of these conditions
  mp_real error_constant;   ///< 2-norm of φ_s(τ) − 1/γ(τ) over the trees of order p + 1, divided by 1 + b
  mp_real ssp_coefficient;  ///< r of the form if all signs hold, else 0
  bool type_a = false;      ///< whether every row but the first relaxes: asymptotic preserving
  bool keeps_slow_terms = false;      ///< (N1), (N2): flux = last = 1 for z → ∞
  intermediate_band band;             ///< max |flux(z) − 1|/z
  mp_real root;                       ///< −b, zero-stable if |b| < 1
  int explicit_evaluations = 0;       ///< of T per step
  int implicit_solves = 0;            ///< per step
  std::vector<std::string> failures;  ///< one line per failed claim
  /// Whether `failures` is empty.
  bool claims_hold() const { return failures.empty(); }
};

/// Certifies a two-step method in arithmetic of 60 digits, with the tolerances of certify().
two_step_certificate certify_two_step(const method& m);

}  // namespace apsis
