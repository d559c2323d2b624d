#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/equal_steps.hpp>

#include <algorithm>
#include <string>
#include <utility>
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

/// Advances any problem by IMEX-BDF: one evaluation of T and one stage solve for each step. As soon as u^n is
/// known, T(u^n) is evaluated once and added to the accumulators of the next k steps, so that no T is stored.
///
/// The first k steps, from u⁰ to u^k, are steps of equal length of the extrapolated Euler method of order k
/// (family extrapolated-euler-S). The formula uses u¹ … u^k but not u⁰, which may be far from equilibrium:
/// T(u⁰) would enter with the weight Δt, although an initial layer lasts only ε.
template <problem P>
class imex_bdf {
 public:
  using state = typename P::state;  ///< type of u
  using real = typename P::real;    ///< type of time and coefficients

  /// Stores a reference to the problem, which must outlive this object. Throws input_error unless 1 ≤ k ≤ 5.
  imex_bdf(int k, P& p)
      : problem_(p),
        m_(imex_bdf_coefficients<real>(k)),
        starter_(find_method(k == 1 ? "forward-backward-euler" : "extrapolated-euler-" + std::to_string(k)),
                 p) {}

  int order() const { return m_.steps(); }         ///< k
  int first_steps() const { return m_.steps(); }   ///< number of steps before the formula holds
  std::string name() const { return "IMEX-BDF"; }  ///< for messages
  stepper<P>& starter() { return starter_; }       ///< method of the first k steps

  /// Adds a value u at time t to an empty or incomplete history, Δt after the last one.
  void add(real t, real dt, const state& u) {
    set_targets(dt, u);
    problem_.add_transport(t, u, targets_);
    ++known_;
  }

  /// Advances u from t to t + dt. Requires a history of k − 1 values with equal steps before u. If the stage
  /// solve throws, u is still the old value, and restart() is required.
  void step(real t, real dt, state& u) {
    set_targets(dt, u);
    state& next = *accumulator(1);
    if constexpr (problem_with_fused_stages<P>) {
      problem_.add_transport_and_solve(t, u, targets_, {t + dt, dt * m_.b, real(0), &next});
    } else {
      problem_.add_transport(t, u, targets_);
      problem_.solve_collision(t + dt, dt * m_.b, real(0), next);
    }
    using std::swap;
    swap(u, next);
    ++known_;
  }

  /// Discards the history.
  void restart() { known_ = 0; }

 private:
  /// Returns the accumulator of the value i steps after the next known one.
  state* accumulator(int i) {
    return &accumulators_[static_cast<std::size_t>(known_ + i) % accumulators_.size()];
  }

  /// Sets the targets of the next known value, for which the accumulators of the next k values exist. That of
  /// the last is the one of the value itself, which is no longer used.
  void set_targets(real dt, const state& u) {
    while (static_cast<int>(accumulators_.size()) < order()) accumulators_.push_back(u);
    targets_.clear();
    for (int i = 1; i <= order(); ++i) {
      const auto k = static_cast<std::size_t>(i - 1);
      targets_.push_back({accumulator(i), m_.a[k], dt * m_.c[k], i == order() || known_ == 0});
    }
  }

  P& problem_;
  multistep_coefficients<real> m_;
  stepper<P> starter_;
  std::vector<state> accumulators_;
  std::vector<target<state, real>> targets_;
  long known_ = 0;  ///< number of values in the history
};

}  // namespace apsis
