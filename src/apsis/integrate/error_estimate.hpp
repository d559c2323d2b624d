#pragma once

#include <apsis/integrate/stepper.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace apsis {

/// What a controller compares errors with: the tolerance of one step and the order q of the embedded
/// solution.
template <class Real>
struct error_target {
  Real tolerance;  ///< in the unit of the errors
  int order;       ///< q; an estimate is of size Δt^{q+1}
};

/// Estimated error of a step: the distance of u^{n+1} from the embedded solution ũ, in which the part off the
/// equilibrium manifold counts less where steps are shorter than the slow part of the solution needs them
/// (docs/methods.md, "Embedded solutions"). With e = u^{n+1} − ũ, δ the relative change of u in the step and
/// tol relative to u,
///   estimate = ‖(w e + v(u^{n+1}) − v(ũ))/(1 + w)‖,   v(x) = x + Δt (1 + 1/w) Q(v(x)),
///   w = (0.6 q δ/tol^{1/(q+1)})^{3/q}.
/// To first order that leaves the part along the manifold as it is and multiplies the rest by
/// (w + 1/(1 + z (1 + 1/w)))/(1 + w), z = CΔt/ε: by 1 for z → 0, w/(1 + w) for z → ∞. For problems that have
/// a relaxation_time; of any other the estimate is ‖e‖.
template <problem P>
class error_estimate {
 public:
  using state = typename P::state;  ///< what u is
  using real = typename P::real;    ///< of errors

  /// Of the step from `start` at t of length dt. distance(u, v) is a norm of u − v, which may be relative to
  /// u. Buffers are allocated at the first call. Throws what the stage solve of the problem throws.
  template <class Distance>
  real operator()(P& p, real t, real dt, const state& start, const attempted_step<state>& tried,
                  const error_target<real>& target, const Distance& distance) {
    if constexpr (problem_with_relaxation_time<P>) {
      if (!relaxes_) relaxes_ = p.relaxation_time(t, start) < std::numeric_limits<real>::infinity();
      if (*relaxes_) return weighed(p, t, dt, start, tried, target, distance);
    }
    return distance(tried.result, tried.embedded);
  }

 private:
  template <class Distance>
  real weighed(P& p, real t, real dt, const state& start, const attempted_step<state>& tried,
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
    // u^{n+1} less the weighed error.
    const real share = real(1) / (real(1) + w);
    add(p, t, tried.result, share, sum, true);
    add(p, t, tried.embedded, w * share, sum, false);
    add(p, t, of_result, -share, sum, false);
    add(p, t, of_embedded, share, sum, false);
    return distance(tried.result, sum);
  }

  /// NaN where u is 0.
  static real weight(real change, real tolerance, int order) {
    using std::pow;
    const real ratio = change / pow(tolerance, real(1) / real(order + 1));
    // Within what keeps a C/ε finite wherever C/ε is.
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

/// Length of the first step: u changes by tol^{1/(q+1)}, relative to u, at the rate D₀/(ε/C) of the initial
/// layer, D₀ = u − E(ℛu) and ε/C the smallest, and at the rate that the moments have at equilibrium. For
/// problems without relaxation_time the rate is that of T + Q, or of T where Q cannot be evaluated. At most
/// `longest`, which it is where nothing changes. Dimensionless.
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
  const real projection = real(1e100);  // a C/ε ≫ 1: v = E(ℛu) to rounding
  // So short that T is seen as linear, so long that rounding is not seen.
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
    return longest;  // invalid u: the step itself reports it
  }
}

}  // namespace apsis
