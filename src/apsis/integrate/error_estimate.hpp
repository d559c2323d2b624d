#pragma once

#include <apsis/integrate/stepper.hpp>
#include <apsis/integrate/verbs.hpp>

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

/// Estimated error of a step: the distance between u^{n+1} and the embedded solution ũ. The component off the
/// equilibrium manifold has less weight where it relaxes within the step or belongs to an initial layer
/// (docs/methods.md, "Embedded solutions"). With e = u^{n+1} − ũ and P(x) = x + aQ(P(x)), a → ∞, the
/// projection to the manifold,
///   estimate = W ‖(w e + v(u^{n+1}) − v(ũ))/(1 + w)‖,   v(x) = x + (Δt/ρ²) Q(v(x)),   w = ρ/(10 W),
///   ρ = ‖P(u^{n+1}) − P(u^n)‖/‖u^{n+1} − u^n‖, between 1/100 and 1.
/// W is the weight of the method (embedded_certificate). To first order the component along the manifold has
/// weight W, and the rest W (w + 1/(1 + z/ρ²))/(1 + w) with z = CΔt/ε. The latter is W for z → 0. For z → ∞
/// it is about 1/10 while u follows its moments (ρ = 1), and at least 1/1000 in a layer, where the moments
/// hardly change. For problems without relaxation_time, and for steps that resolve collisions, the estimate
/// is W ‖e‖.
template <problem P>
class error_estimate {
 public:
  using state = typename P::state;  ///< type of u
  using real = typename P::real;    ///< type of errors

  /// `weight`: W, of the method (stepper::weight_of_estimate). `resolves`: whether steps resolve collisions
  /// (stepper::resolves_collisions).
  explicit error_estimate(real weight = real(1), bool resolves = false) : weight_(weight) {
    if (resolves) relaxes_ = false;
  }

  /// Estimates the error of a step of length dt from `start` at time t. distance(u, v) is a norm of u − v,
  /// which may be relative to u. Buffers are allocated at the first call. Throws what the stage solve of
  /// the problem throws.
  template <class Distance>
  real operator()(P& p, real t, real dt, const state& start, const attempted_step<state>& tried,
                  const Distance& distance) {
    if constexpr (problem_with_relaxation_time<P>) {
      if (!relaxes_) relaxes_ = p.relaxation_time(t, start) < std::numeric_limits<real>::infinity();
      if (*relaxes_) return weighted_estimate(p, t, dt, start, tried, distance);
    }
    return weight_ * distance(tried.result, tried.embedded);
  }

 private:
  template <class Distance>
  real weighted_estimate(P& p, real t, real dt, const state& start, const attempted_step<state>& tried,
                         const Distance& distance) {
    while (buffers_.size() < 3) buffers_.push_back(start);
    state &sum = buffers_[0], &of_result = buffers_[1], &of_other = buffers_[2];
    of_result = tried.result;
    of_other = start;
    project_to_equilibrium(p, t + dt, of_result);
    project_to_equilibrium(p, t + dt, of_other);
    const real change = distance(tried.result, start), ratio = distance(of_result, of_other) / change;
    if (!(change > real(0))) return weight_ * distance(tried.result, tried.embedded);
    const real rho = std::clamp(ratio, real(0.01), real(1)), w = rho / (real(10) * weight_);
    of_result = tried.result;
    of_other = tried.embedded;
    for (state* v : {&of_result, &of_other}) p.solve_collision(t + dt, dt / (rho * rho), real(0), *v);
    // u^{n+1} minus the weighted error.
    const real share = real(1) / (real(1) + w);
    combine(p,
            {{share, &tried.result}, {w * share, &tried.embedded}, {-share, &of_result}, {share, &of_other}},
            sum);
    return weight_ * distance(tried.result, sum);
  }

  real weight_;
  std::vector<state> buffers_;
  std::optional<bool> relaxes_;
};

/// Returns the length of the first step, in which u changes by tol^{1/(q+1)}, relative to u. The rate of
/// change is the larger of two: that of the moments at equilibrium, and the rate D₀/(ε/C) of the initial
/// layer, with D₀ = u − E(ℛu) and the smallest ε/C. The layer counts only if it changes the moments by more
/// than tol; their change is (ε/C) ℛ(T(u) − T(E(ℛu))). For problems without relaxation_time the rate is that
/// of T + Q, or of T if Q cannot be evaluated. The rate is measured over a time much shorter than the step.
/// Over a long time the distance may no longer grow, as where it is relative to the larger state. The result
/// is at most `longest`, and `longest` if nothing changes. Dimensionless.
template <problem P, class Distance>
typename P::real first_step_length(P& p, typename P::real t, const typename P::state& u,
                                   typename P::real longest, const error_target<typename P::real>& wanted,
                                   const Distance& distance) {
  using real = typename P::real;
  using state = typename P::state;
  using std::pow;
  const auto move = [&](const state& from, real tau, state& sum) {  // sum ← from + τ T(from)
    const target<state, real> to{&sum, real(1), tau, true};
    p.add_transport(t, from, {&to, 1});
  };
  real layer = std::numeric_limits<real>::infinity();
  if constexpr (problem_with_relaxation_time<P>) layer = p.relaxation_time(t, u);
  const bool relaxes = layer < std::numeric_limits<real>::infinity();
  // Short enough for T to be linear, long enough for rounding errors to be negligible.
  real tau = longest * real(1e-5);
  state before = u, after = u;
  try {
    combine(p, {{real(0), &u}}, after);
    const real size = distance(u, after),
               part = pow(wanted.tolerance / size, real(1) / real(wanted.order + 1));
    if (relaxes) project_to_equilibrium(p, t, before);
    const auto moved_from = [&](const state& from) {
      state moved = u;
      move(from, layer, moved);
      project_to_equilibrium(p, t, moved);
      return moved;
    };
    const bool layer_matters = relaxes && distance(moved_from(u), moved_from(before)) > wanted.tolerance;
    const real of_layer = layer_matters ? distance(u, before) / size / layer : real(0);
    const auto rate_over = [&](real time) {
      move(before, time, after);
      if constexpr (problem_with_explicit_collision<P> && !problem_with_relaxation_time<P>) {
        const target<state, real> by_collision{&after, real(0), time, false};
        p.add_collision(t, before, {&by_collision, 1});
      }
      if (relaxes) project_to_equilibrium(p, t + time, after);
      return std::max(of_layer, distance(before, after) / size / time) / part;
    };
    real rate = rate_over(tau);
    for (int shorter = 0; shorter < 30 && rate * tau > real(0.1); ++shorter) {
      tau = real(1e-2) / rate;
      rate = rate_over(tau);
    }
    return rate * longest > real(1) ? real(1) / rate : longest;
  } catch (const numerical_error&) {
    return longest;  // invalid u: the step will report it
  }
}

}  // namespace apsis
