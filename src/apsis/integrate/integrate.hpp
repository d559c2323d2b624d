#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/stepper.hpp>
#include <apsis/integrate/time_marcher.hpp>

#include <limits>
#include <optional>

namespace apsis {

/// Treatment of the first step: unchanged, or divided into graded steps that resolve the initial layer of
/// data out of equilibrium (graded_start), for methods that violate (N3) of docs/plateaus.md.
enum class startup { none, graded };

/// Step-size rule: a given dt, or Δt = safety · r · Δt_FE (safety ≤ 1 preserves what
/// forward Euler preserves).
template <class Real>
struct step_rule {
  std::optional<Real> dt;         ///< the given step; without it the SSP rule applies
  Real safety = Real(1);          ///< ignored if dt is given
  startup start = startup::none;  ///< treatment of the first step
  int growth = default_growth;    ///< ratio of the times of a graded start

  /// Returns the rule of steps of length dt.
  static step_rule fixed(Real dt) { return {dt, Real(1)}; }
  /// Returns the rule Δt = safety · r · Δt_FE, for methods with an
  /// SSP coefficient (stepper::require_ssp_coefficient()).
  static step_rule ssp(Real safety = Real(1)) { return {std::nullopt, safety}; }
  /// Returns the rule of unlimited steps, for integrate_to_tolerance().
  static step_rule unlimited() { return fixed(std::numeric_limits<Real>::infinity()); }
  /// Returns the same rule with the given start-up. `ratio`, from 2 to largest_growth, is that of successive
  /// times of a graded start. For methods of order 5 and more, 4 or 8 saves half or two thirds of its steps.
  step_rule with(startup first, int ratio = default_growth) const { return {dt, safety, first, ratio}; }
};

/// Summary of an integration.
template <class Real>
struct integration_result {
  Real t;              ///< time reached: t1, or the time at which the observer stopped
  long steps;          ///< number of steps, including start-up steps
  Real dt;             ///< longest step; 0 if there was none
  long startup_steps;  ///< number of start-up steps; 0 without start-up
};

/// Observer that does nothing.
struct no_observer {
  /// Does nothing.
  template <class... Args>
  void operator()(Args&&...) const {}
};

/// Returns the longest step from u at t by the rule. Throws input_error if the rule is ssp() and the method
/// has no SSP coefficient.
template <problem P>
typename P::real rule_limit(stepper<P>& method_stepper, const step_rule<typename P::real>& rule,
                            typename P::real t, const typename P::state& u) {
  if (rule.dt) return *rule.dt;
  return rule.safety * method_stepper.require_ssp_coefficient() *
         method_stepper.problem().forward_euler_step(t, u);
}

/// Returns the width ε/C of the initial layer of u. Throws input_error if the problem has no relaxation_time.
template <problem P>
typename P::real initial_layer(P& p, typename P::real t, const typename P::state& u) {
  if constexpr (problem_with_relaxation_time<P>) {
    return p.relaxation_time(t, u);
  } else {
    throw input_error(
        "a graded start needs the width of the initial layer (the problem has no relaxation_time(t, u)); "
        "define it, or start without grading");
  }
}

/// Integrates u along `march`; take(march, limit, u) takes one step of length `limit` at most and returns its
/// length, without advancing the marcher.
template <problem P, class Take, class Observer>
integration_result<typename P::real> integrate_with(const Take& take, stepper<P>& method_stepper,
                                                    time_marcher<typename P::real> march,
                                                    typename P::state& u, step_rule<typename P::real> rule,
                                                    Observer&& observer) {
  using real = typename P::real;
  real longest(0);
  const auto report = [&](real dt) {
    if constexpr (std::is_convertible_v<decltype(observer(0L, dt, dt, u)), bool>) {
      return static_cast<bool>(observer(march.step(), march.t(), dt, u));
    } else {
      observer(march.step(), march.t(), dt, u);
      return true;
    }
  };
  const auto limit = [&]() -> real { return rule_limit(method_stepper, rule, march.t(), u); };
  bool wanted = report(real(0));
  if (wanted && rule.start == startup::graded && !march.done())
    march.start_up(limit(), initial_layer(method_stepper.problem(), march.t(), u));
  while (wanted && !march.done()) {
    try {
      const real dt = take(march, limit(), u);
      march.advance(dt);
      longest = longest > dt ? longest : dt;
      wanted = report(dt);
    } catch (const numerical_error& failure) {
      throw failure.site().step >= 0 ? failure : failure.at(march.step() + 1, static_cast<double>(march.t()));
    }
  }
  return {march.t(), march.step(), longest, march.startup_steps()};
}

/// Integrates u from t0 to t1. observer(step, t, dt, u) is called for the initial state (step 0, dt 0) and
/// after every step; if it returns a bool, false ends the integration. Throws numerical_error with step and
/// time if a step fails; u is then the last accepted state. Throws input_error if the rule cannot be applied,
/// or for a graded start-up of a problem without relaxation_time.
template <problem P, class Observer = no_observer>
integration_result<typename P::real> integrate(stepper<P>& method_stepper, typename P::state& u,
                                               typename P::real t0, typename P::real t1,
                                               step_rule<typename P::real> rule, Observer&& observer = {}) {
  using real = typename P::real;
  const auto take = [&](const time_marcher<real>& march, real limit, typename P::state& state) {
    const real dt = march.next(limit);
    method_stepper.step(march.t(), dt, state);
    return dt;
  };
  return integrate_with(take, method_stepper, time_marcher<real>(t0, t1, rule.dt, rule.growth), u, rule,
                        observer);
}

}  // namespace apsis
