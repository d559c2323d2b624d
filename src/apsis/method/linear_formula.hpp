#pragma once

#include <apsis/method/precision.hpp>

#include <vector>

namespace apsis {

/// Coefficients of a formula of k equal steps with one stage:
///   u^{n+1} = Σ_{i=1}^k (a_i u^{n+1−i} + Δt c_i T(u^{n+1−i})) + Δt b Q(u^{n+1}).
template <class Real>
struct linear_formula {
  std::vector<Real> a,                                      ///< weights of earlier values, a_1 that of u^n
      c;                                                    ///< of their transport
  Real b{};                                                 ///< of the collision at the new time
  int steps() const { return static_cast<int>(a.size()); }  ///< k
};

/// Order and error constants of a formula. A formula of order p is exact for polynomials up to degree p.
struct formula_orders {
  int order = 0;          ///< p, the smaller of those of T and Q
  mp_real residual,       ///< largest defect of polynomials up to degree p
      implicit_constant,  ///< defect of t^{p+1}/(p + 1)! with T = 0, divided by b
      explicit_constant;  ///< the same with Q = 0
};

/// Computes order and constants from 1 = Σ_i a_i x_i^q + q b = Σ_i (a_i x_i^q + q c_i x_i^{q−1}), where x_i =
/// 1 − i. Times are in units of Δt from t_n, so that t_{n+1} = 1.
formula_orders compute_formula_orders(const linear_formula<mp_real>& m);

/// Returns Σ_n |h_n − h_{n−1}|, the largest change of u in one step where every step adds an error of at most
/// 1. h_n = Σ_i a_i h_{n−i} with h_0 = 1 is the effect of a single error after n steps. For the weights
/// (1 − b, b), 0 ≤ b < 1, it is 1/(1 − b). Requires all roots but 1 within the unit circle.
double error_amplification(const std::vector<double>& weights);

}  // namespace apsis
