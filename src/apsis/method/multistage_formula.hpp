#pragma once

#include <apsis/core/matrix.hpp>
#include <apsis/method/precision.hpp>

#include <cstddef>
#include <vector>

namespace apsis {

/// Coefficients of an IMEX general linear method with s stages U_i ≈ u(t_n + c_i Δt) and s values y_i that
/// steps of equal length hand on:
///   U_i = y_i + Δt Σ_{j<i} â_ij T(U_j) + Δt Σ_{j≤i} a_ij Q(U_j),
///   y_i ← Σ_j v_j y_j + Δt Σ_j b̂_ij T(U_j) + Δt Σ_j b_ij Q(U_j).
/// The diagonal of A is λ, and the last abscissa c_s is 1, so that u^{n+1} = U_s. Dimensionless.
template <class Real>
struct multistage_formula {
  std::vector<Real> c,                             ///< abscissae
      v;                                           ///< weights of the handed-on values; their sum is 1
  matrix<Real> A,                                  ///< coefficients of Q in stages, lower triangular
      A_hat,                                       ///< of T in stages, strictly lower triangular
      B,                                           ///< of Q in the new values
      B_hat;                                       ///< of T in the new values
  std::size_t stages() const { return c.size(); }  ///< s
  const Real& lambda() const { return A(0, 0); }   ///< λ > 0

  /// Returns the formula in another number type, each coefficient correctly rounded. The last v_j is 1 minus
  /// the sum of the others.
  template <class Other>
  multistage_formula<Other> in() const;
};

template <class Real>
template <class Other>
multistage_formula<Other> multistage_formula<Real>::in() const {
  multistage_formula<Other> m;
  for (const Real& abscissa : c) m.c.push_back(static_cast<Other>(abscissa));
  Other rest(1);
  for (std::size_t j = 0; j + 1 < v.size(); ++j) {
    m.v.push_back(static_cast<Other>(v[j]));
    rest -= m.v.back();
  }
  m.v.push_back(rest);
  const auto rounded = [](const matrix<Real>& exact) {
    matrix<Other> numbers(exact.rows(), exact.cols());
    for (std::size_t i = 0; i < exact.rows(); ++i)
      for (std::size_t j = 0; j < exact.cols(); ++j) numbers(i, j) = static_cast<Other>(exact(i, j));
    return numbers;
  };
  m.A = rounded(A);
  m.A_hat = rounded(A_hat);
  m.B = rounded(B);
  m.B_hat = rounded(B_hat);
  return m;
}

/// Solves Σ_j w_j x_j^k = m_k, k = 0 … n − 1, for w, given distinct x: the weights of a formula with the
/// moments m (Björck, Pereyra, Math. Comp. 24 (1970) 893–903).
template <class Real>
std::vector<Real> weights_with_moments(const std::vector<Real>& x, std::vector<Real> m) {
  const std::size_t n = x.size();
  for (std::size_t k = 0; k + 1 < n; ++k)
    for (std::size_t i = n - 1; i > k; --i) m[i] -= x[k] * m[i - 1];
  for (std::size_t k = n - 1; k-- > 0;) {
    for (std::size_t i = k + 1; i < n; ++i) m[i] /= x[i] - x[i - k - 1];
    for (std::size_t i = k; i + 1 < n; ++i) m[i] -= m[i + 1];
  }
  return m;
}

/// Returns the Taylor coefficients q_ik, k = 0 … degree, of the handed-on values for stages with the
/// coefficients A: y_i = Σ_k q_ik Δt^k u^{(k)}(t_n), where q_i0 = 1 and
///   q_ik = c_i^k/k! − Σ_j a_ij c_j^{k−1}/(k − 1)!.
template <class Real>
matrix<Real> taylor_coefficients(const std::vector<Real>& c, const matrix<Real>& A, int degree) {
  matrix<Real> q(c.size(), static_cast<std::size_t>(degree) + 1);
  for (std::size_t i = 0; i < c.size(); ++i) {
    q(i, 0) = Real(1);
    Real power(1);  // c_i^{k−1}/(k − 1)!
    std::vector<Real> powers(c.size(), Real(1));
    for (int k = 1; k <= degree; ++k) {
      power *= c[i] / Real(k);
      Real sum = power;
      for (std::size_t j = 0; j < c.size(); ++j) {
        sum -= A(i, j) * powers[j];
        powers[j] *= c[j] / Real(k);
      }
      q(i, static_cast<std::size_t>(k)) = sum;
    }
  }
  return q;
}

/// Returns the right sides Σ_{m≤k} q_im/(k − m)! − Σ_j v_j q_jk of the order conditions of y_i, k = 1 …
/// degree: a formula is exact for u^{(k)} if Σ_j b_ij c_j^{k−1}/(k − 1)! equals them (Butcher, Numerical
/// Methods for Ordinary Differential Equations, section 53).
template <class Real>
std::vector<Real> required_moments(const std::vector<Real>& v, const matrix<Real>& q, std::size_t i,
                                   int degree) {
  std::vector<Real> all;
  for (int k = 1; k <= degree; ++k) {
    Real sum(0), factor(1);  // 1/(k − m)!
    for (int m = k; m >= 0; --m) {
      sum += factor * q(i, static_cast<std::size_t>(m));
      factor /= Real(k - m + 1);
    }
    for (std::size_t j = 0; j < v.size(); ++j) sum -= v[j] * q(j, static_cast<std::size_t>(k));
    all.push_back(sum);
  }
  return all;
}

/// Returns the s × s matrix B for which the formula of A has order and stage order s.
template <class Real>
matrix<Real> new_value_coefficients(const std::vector<Real>& c, const std::vector<Real>& v,
                                    const matrix<Real>& A) {
  const auto s = static_cast<int>(c.size());
  const auto q = taylor_coefficients(c, A, s);
  matrix<Real> B(c.size(), c.size());
  for (std::size_t i = 0; i < c.size(); ++i) {
    auto moments = required_moments(v, q, i, s);
    Real factorial(1);
    for (int k = 1; k <= s; ++k) {
      moments[static_cast<std::size_t>(k - 1)] *= factorial;  // (k − 1)!
      factorial *= Real(k);
    }
    const auto weights = weights_with_moments(c, moments);
    for (std::size_t j = 0; j < c.size(); ++j) B(i, j) = weights[j];
  }
  return B;
}

/// Weights of earlier values from which the first y_i are computed:
///   y_i = Σ_{l=0}^s (α_il u^{n−l} + Δt β_il T(u^{n−l})).
template <class Real>
struct starting_weights {
  matrix<Real> alpha,  ///< s × (s + 1)
      beta;            ///< s × (s + 1); the last column is 0
};

/// Returns the weights that are exact for polynomials up to degree s. Q = u' − T is not evaluated: α
/// differentiates the values, and β corrects the parts of T.
template <class Real>
starting_weights<Real> compute_starting_weights(const multistage_formula<Real>& m) {
  const std::size_t s = m.stages();
  const auto degree = static_cast<int>(s);
  const auto of_q = taylor_coefficients(m.c, m.A, degree), of_t = taylor_coefficients(m.c, m.A_hat, degree);
  std::vector<Real> all, recent;  // times in units of Δt from t_n
  for (std::size_t l = 0; l <= s; ++l) all.push_back(-Real(static_cast<int>(l)));
  recent.assign(all.begin(), all.end() - 1);
  starting_weights<Real> w{matrix<Real>(s, s + 1), matrix<Real>(s, s + 1)};
  for (std::size_t i = 0; i < s; ++i) {
    std::vector<Real> values, transport;
    Real factorial(1);  // k!, then (k − 1)!
    for (std::size_t k = 0; k <= s; ++k) {
      if (k > 0) {
        transport.push_back(factorial * (of_t(i, k) - of_q(i, k)));
        factorial *= Real(static_cast<int>(k));
      }
      values.push_back(factorial * of_q(i, k));
    }
    const auto alpha = weights_with_moments(all, values), beta = weights_with_moments(recent, transport);
    for (std::size_t l = 0; l <= s; ++l) {
      w.alpha(i, l) = alpha[l];
      w.beta(i, l) = l < s ? beta[l] : Real(0);
    }
  }
  return w;
}

/// Order and error constants of a formula.
struct multistage_orders {
  int order = 0;          ///< p = stage order, the smaller of those of T and Q
  mp_real residual,       ///< largest defect of the conditions up to order p
      implicit_constant,  ///< largest defect of the handed-on values at order p + 1 with T = 0
      explicit_constant;  ///< the same with Q = 0
};

/// Computes the order from the conditions of required_moments() for A and Â. Stages and handed-on values are
/// exact for polynomials up to degree p. Such a formula has order p for every T and Q, without conditions
/// that couple both (Zhang, Sandu, Blaise, J. Sci. Comput. 61 (2014) 119–144).
multistage_orders compute_multistage_orders(const multistage_formula<mp_real>& m);

}  // namespace apsis
