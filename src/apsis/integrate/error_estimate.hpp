#pragma once

#include <apsis/integrate/stepper.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace apsis {

/// Tolerance of one step and order q of the embedded solution.
template <class Real>
struct error_target {
  Real tolerance;  ///< has the unit of the errors
  int order;       ///< q; the estimate is of size Δt^{q+1}
};

/// Estimated error of a step: the distance between u^{n+1} and the embedded solution ũ, in which the
/// component off the equilibrium manifold has less weight where steps are shorter than the slow part of the
/// solution requires (docs/methods.md, "Embedded solutions"). With e = u^{n+1} − ũ, δ the relative change of
/// u in the step and tol relative to u,
///   estimate = ‖(w e + v(u^{n+1}) − v(ũ))/(1 + w)‖,   v(x) = x + Δt (1 + 1/w) Q(v(x)),
///   w = (0.6 q δ/tol^{1/(q+1)})^{3/q}.
/// To first order this keeps the component along the manifold and multiplies the rest by (w + 1/(1 + z (1 +
/// 1/w)))/(1 + w), z = CΔt/ε: that is, by 1 for z → 0 and w/(1 + w) for z → ∞. For problems without
/// relaxation_time the estimate is ‖e‖.
template <problem P>
class error_estimate {
 public:
  using state = typename P::state;  ///< type of u
  using real = typename P::real;    ///< type of errors

  /// Estimates the error of a step of length dt from `start` at time t. distance(u, v) is a norm of u − v,
  /// which may be relative to u. Buffers are allocated at the first call. Throws what the stage solve of
  /// the problem throws.
  template <class Distance>
  real operator()(P& p, real t, real dt, const state& start, const attempted_step<state>& tried,
                  const error_target<real>& target, const Distance& distance) {
    if constexpr (problem_with_relaxation_time<P>) {
      if (!relaxes_) relaxes_ = p.relaxation_time(t, start) < std::numeric_limits<real>::infinity();
      if (*relaxes_) return weighted_estimate(p, t, dt, start, tried, target, distance);
    }
    return distance(tried.result, tried.embedded);
  }

 private:
  template <class Distance>
  real weighted_estimate(P& p, real t, real dt, const state& start, const attempted_step<state>& tried,
                         const error_target<real>& target, const Distance& distance) {
    while (buffers_.size() < 3) buffers_.push_back(start);
    state &sum = buffers_[0], &of_result = buffers_[1], &of_embedded = buffers_[2];
    add(p, t, tried.result, real(0), sum, true);
    const real size = distance(tried.result, sum);
    const real w = weight(distance(tried.result, start) / size, target.tolerance / size, target.order);
    if (!(w > real(0))) return distance(tried.result, tried.embedded);  // u = 0
    of_result = tried.result;
    of_embedded = tried.embedded;
    p.solve_collision(t + dt, dt * (real(1) + real(1) / w), real(0), of_result);
    p.solve_collision(t + dt, dt * (real(1) + real(1) / w), real(0), of_embedded);
    // u^{n+1} minus the weighted error.
    const real share = real(1) / (real(1) + w);
    add(p, t, tried.result, share, sum, true);
    add(p, t, tried.embedded, w * share, sum, false);
    add(p, t, of_result, -share, sum, false);
    add(p, t, of_embedded, share, sum, false);
    return distance(tried.result, sum);
  }

  /// Returns w; NaN if u = 0.
  static real weight(real change, real tolerance, int order) {
    using std::pow;
    const real ratio = change / pow(tolerance, real(1) / real(order + 1));
    // In a range in which a C/ε is finite wherever C/ε is.
    return ratio >= real(0) ? std::clamp(pow(real(0.6) * real(order) * ratio, real(3) / real(order)),
                                         real(1e-30), real(1e30))
                            : ratio;
  }

  static void add(P& p, real t, const state& u, real alpha, state& sum, bool fresh) {
    const target<state, real> to{&sum, alpha, real(0), fresh};
    p.add_transport(t, u, {&to, 1});
  }

  std::vector<state> buffers_;
  std::optional<bool> relaxes_;
};

/// Returns the length of the first step: that in which u changes by tol^{1/(q+1)}, relative to u, at the rate
/// D₀/(ε/C) of the initial layer, D₀ = u − E(ℛu) and ε/C the smallest, and at the rate of the moments at
/// equilibrium. For problems without relaxation_time the rate is that of T + Q, or of T if Q cannot be
/// evaluated. At most `longest`, which is also the result if nothing changes. Dimensionless.
template <problem P, class Distance>
typename P::real first_step_length(P& p, typename P::real t, const typename P::state& u,
                                   typename P::real longest, const error_target<typename P::real>& wanted,
                                   const Distance& distance) {
  using real = typename P::real;
  using state = typename P::state;
  using std::pow;
  const auto add = [&](const state& from, real alpha, real beta, state& sum) {
    const target<state, real> to{&sum, alpha, beta, true};
    p.add_transport(t, from, {&to, 1});
  };
  real layer = std::numeric_limits<real>::infinity();
  if constexpr (problem_with_relaxation_time<P>) layer = p.relaxation_time(t, u);
  const bool relaxes = layer < std::numeric_limits<real>::infinity();
  const real projection = real(1e100);  // a C/ε ≫ 1: v = E(ℛu) up to rounding
  // Short enough for T to be linear, long enough for rounding errors to be negligible.
  const real tau = longest * real(1e-5);
  state before = u, after = u;
  try {
    add(u, real(0), real(0), after);
    const real size = distance(u, after),
               part = pow(wanted.tolerance / size, real(1) / real(wanted.order + 1));
    if (relaxes) p.solve_collision(t, projection, real(0), before);
    const real of_layer = distance(u, before) / size / layer;
    add(before, real(1), tau, after);
    if constexpr (problem_with_explicit_collision<P> && !problem_with_relaxation_time<P>) {
      const target<state, real> by_collision{&after, real(0), tau, false};
      p.add_collision(t, before, {&by_collision, 1});
    }
    if (relaxes) p.solve_collision(t + tau, projection, real(0), after);
    const real rate = std::max(of_layer, distance(before, after) / size / tau) / part;
    return rate * longest > real(1) ? real(1) / rate : longest;
  } catch (const numerical_error&) {
    return longest;  // invalid u: the step will report it
  }
}

}  // namespace apsis
