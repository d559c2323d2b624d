#pragma once

#include <apsis/core/matrix.hpp>

#include <vector>

namespace apsis {

/// Butcher form of a multi-derivative additive Runge–Kutta method with s stages, u^{n+1} = u_s:
///   u_i = u^n + Δt Σ_j â_ij T(u_j) + Δt Σ_j a_ij Q(u_j) + Δt² Σ_j ȧ_ij Q̇(u_j)
/// (paper, eq. IMEXRKButcher). All matrices are s × s and lower triangular, Â strictly. Dimensionless.
template <class Real>
struct butcher_form {
  matrix<Real> A_hat,                              ///< Â, coefficients of T
      A,                                           ///< coefficients of Q
      A_dot;                                       ///< Ȧ, coefficients of Q̇
  std::size_t stages() const { return A.rows(); }  ///< s
};

/// Shu–Osher form, with the off-diagonal multiples of Q that comparators outside the paper's class need:
///   u_i = r_i u^n + Σ_{j<i} p_ij u_j + Σ_{j<i} w_ij (u_j + (Δt/r) T(u_j))
///         + Δt Σ_{j≤i} d_ij Q(u_j) + Δt² ḋ_i Q̇(u_i),        r_i = 1 − Σ_j (p_ij + w_ij)
/// (paper, eq. IMEX-RK, where D is diagonal). P, W, D are s × s, P and W strictly lower triangular,
/// D lower triangular; ddot carries its sign (≤ 0 for an SSP method). r > 0; for W = 0 it is 1.
template <class Real>
struct shu_osher_form {
  matrix<Real> P,                                     ///< weights p_ij of u_j
      W,                                              ///< weights w_ij of forward Euler steps of length Δt/r
      D;                                              ///< d_ij
  std::vector<Real> ddot;                             ///< ḋ_i
  Real r{};                                           ///< at most the SSP coefficient if the form is convex
  std::size_t stages() const { return ddot.size(); }  ///< s
};

/// Returns the row sums of R = I − P − W, the weights r_i of u^n.
template <class Real>
std::vector<Real> initial_weights(const shu_osher_form<Real>& m);

/// Returns the Butcher form Â = R⁻¹W/r, A = R⁻¹D, Ȧ = R⁻¹Ḋ.
template <class Real>
butcher_form<Real> to_butcher(const shu_osher_form<Real>& m);

/// Returns the Shu–Osher form for given unit lower triangular R and r > 0: W = rRÂ, D = RA, ḋ = diag(RȦ), P
/// = I − R − W. It represents the same method if RȦ is diagonal; stage_matrix() finds the R that the
/// paper's class requires.
template <class Real>
shu_osher_form<Real> to_shu_osher(const butcher_form<Real>& b, const matrix<Real>& R, const Real& r);

}  // namespace apsis
