#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/precision.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace apsis {

/// Coefficients of a k-step formula with equal steps:
///   u^{n+1} = Σ_{i=1}^k (a_i u^{n+1−i} + Δt c_i T(u^{n+1−i})) + Δt b Q(u^{n+1}).
template <class Real>
struct multistep_coefficients {
  std::vector<Real> a,                                      ///< weights of earlier values, a_1 that of u^n
      c;                                                    ///< of their transport
  Real b{};                                                 ///< of the collision at the new time
  int steps() const { return static_cast<int>(a.size()); }  ///< k
};

/// Returns IMEX-BDF of order k: the backward differentiation formula Σ_{j=1}^k ∇^j u^{n+1}/j = Δt (T +
/// Q)^{n+1} with T extrapolated, T^{n+1} ≈ Σ_i (−1)^{i−1} C(k,i) T^{n+1−i}. Uniformly accurate in ε for data
/// near equilibrium (Hu, Shu, Math. Comp. 90 (2021) 641–670); k = 2 … 5 are the formulas SBDF (Ascher, Ruuth,
/// Wetton, SIAM J. Numer. Anal. 32 (1995) 797–823). Signs are not preserved: some a_i and c_i are negative
/// for k ≥ 2. Throws input_error unless 1 ≤ k ≤ 5.
template <class Real>
multistep_coefficients<Real> imex_bdf_coefficients(int k) {
  if (k < 1 || k > 5)
    throw input_error("there is no IMEX-BDF method of order " + std::to_string(k) +
                      " here (its orders are 1 to 5); choose one of these");
  multistep_coefficients<Real> m;
  Real leading(0);  // of u^{n+1}
  for (int j = 1; j <= k; ++j) leading += Real(1) / Real(j);
  const auto binomial = [](int n, int i) {
    Real product(1);
    for (int l = 1; l <= i; ++l) product = product * Real(n + 1 - l) / Real(l);
    return product;
  };
  for (int i = 1; i <= k; ++i) {
    const Real sign(i % 2 == 0 ? -1 : 1);
    Real sum(0);
    for (int j = i; j <= k; ++j) sum += binomial(j, i) / Real(j);
    m.a.push_back(sign * sum / leading);
    m.c.push_back(sign * binomial(k, i) / leading);
  }
  m.b = Real(1) / leading;
  return m;
}

/// Orders of a multistep formula: it is exact for polynomials up to a degree.
struct multistep_orders {
  int order = 0;          ///< p, the smaller of those of T and Q
  mp_real residual,       ///< largest defect of polynomials up to degree p
      implicit_constant,  ///< defect of t^{p+1}/(p + 1)! with T = 0, divided by b
      explicit_constant;  ///< the same with Q = 0
};

/// Computes them from 1 = Σ_i a_i x_i^q + q b = Σ_i (a_i x_i^q + q c_i x_i^{q−1}), x_i = 1 − i in units of Δt
/// from t_n, t_{n+1} = 1.
multistep_orders find_multistep_orders(const multistep_coefficients<mp_real>& m);

/// A method of several equal steps: a two-step method (two_step.hpp) or IMEX-BDF of an order k.
struct multistep_method {
  std::string name,             ///< "two-step-10-3-mixed", "imex-bdf-3", or the name in a method file
      title,                    ///< one line
      starter;                  ///< method of the first steps
  int order = 0;                ///< p
  int steps = 0;                ///< k, also the number of the first steps
  std::size_t stages = 1;       ///< number of implicit stages of a step
  double ssp_coefficient = 0;   ///< the smaller r of the method and of its starter; 0 if one is not convex
  std::vector<double> weights;  ///< of u^n, u^{n−1}, … in u^{n+1} for T = Q = 0
  /// Weights of values and solves: the first k − 1 rows stand for u^{n−k+1} … u^{n−1}. Of IMEX-BDF it has no
  /// transport, because T(u^n) has no place in it.
  shu_osher_form<double> form;
  std::optional<method> rows;  ///< of a two-step method, as in its file
};

/// Returns the multistep method called `name`: one of two-step-methods/, "imex-bdf-k", or the path FILE.toml
/// of a two-step method. Throws input_error with the closest name, claim_error if a claim fails, io_error if
/// a file cannot be read.
multistep_method find_multistep_method(const std::string& name);

/// Whether `name` is that of a multistep method, or the path of the file of a two-step method. Throws
/// input_error if a method file is not valid, io_error if it cannot be read.
bool is_multistep_method(const std::string& name);

/// Returns the names of the multistep methods that the library contains.
std::vector<std::string> multistep_method_names();

/// Returns the names of the catalogue and of the multistep methods.
std::vector<std::string> all_method_names();

/// Returns the claimed order of a method of one or several steps. Throws like find_method().
int order_of_method(const std::string& name);

/// Returns Σ_n |h_n − h_{n−1}|, the largest change of u in one step where every step adds an error of at most
/// 1. h_n = Σ_i a_i h_{n−i} with h_0 = 1 is the effect of a single error after n steps. For the weights
/// (1 − b, b), 0 ≤ b < 1, it is 1/(1 − b). Requires all roots but 1 within the unit circle.
double error_amplification(const std::vector<double>& weights);

}  // namespace apsis
