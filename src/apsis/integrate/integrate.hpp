#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/stepper.hpp>

#include <cmath>
#include <limits>
#include <optional>

namespace apsis {

/// How long a step is: a given dt, or Δt = safety · r · Δt_FE (safety ≤ 1 keeps what forward Euler keeps).
template <class Real>
struct step_rule {
  std::optional<Real> dt;
  Real safety = Real(1);

  static step_rule fixed(Real dt) { return {dt, Real(1)}; }
  static step_rule ssp(Real safety = Real(1)) { return {std::nullopt, safety}; }
};

/// Time from t0 to t1 in steps. With a given dt times are t0 + n dt (no accumulation of rounding); a dt that
/// does not divide t1 − t0 (to 1e-12) is reduced until it does, see adjusted(). Without one, the last step is
/// shortened to meet t1. An interval of length zero has no steps.
template <class Real>
class time_marcher {
 public:
  /// All that changes on the way, so that a restart goes on to the same last digit.
  struct progress {
    long step, since_anchor;
    Real t, anchor, anchor_dt;
  };

  /// Throws input_error unless t0 ≤ t1 are finite and dt > 0.
  time_marcher(Real t0, Real t1, std::optional<Real> dt = std::nullopt)
      : t0_(t0), t1_(t1), t_(t0), fixed_(dt) {
    using std::isfinite, std::abs, std::ceil, std::round;
    if (!isfinite(t0) || !isfinite(t1) || t1 < t0)
      throw input_error(
          "the time interval does not exist (its end lies before its start, or is not finite); "
          "give finite t0 ≤ t1");
    if (!dt) return;
    if (!(*dt > Real(0)) || !isfinite(*dt)) throw input_error("dt is not a positive number; give dt > 0");
    const Real length = t1 - t0;
    const Real ratio = length / *dt;
    if (ratio > Real(1e15))
      throw input_error("dt is too small for the interval (more than 1e15 steps); enlarge it");
    const Real nearest = round(ratio);
    const bool divides = abs(nearest * *dt - length) <= Real(1e-12) * length;
    count_ = static_cast<long>(divides ? nearest : ceil(ratio));
    if (count_ > 0) {
      adjusted_ = !divides;
      fixed_ = length / Real(count_);
    }
  }

  bool done() const { return fixed_ ? n_ >= count_ : !(t_ < t1_); }
  Real t() const { return t_; }
  long step() const { return n_; }
  /// The given dt did not divide the interval.
  bool adjusted() const { return adjusted_; }
  /// The given dt after adjustment.
  std::optional<Real> fixed_dt() const { return fixed_; }

  /// The length of the next step, where `proposed` is what the rule allows (ignored if dt was given).
  /// Throws input_error if nothing limits it, numerical_error if it does not advance time.
  Real next(Real proposed) const {
    using std::isinf;
    if (fixed_) return *fixed_;
    if (isinf(proposed) && proposed > Real(0))
      throw input_error(
          "nothing limits the time step (the transport sets no forward Euler step, or the method is "
          "unconditionally stable); give dt");
    const Real rest = t1_ - t_;
    if (rest < proposed) return rest;
    if (!(t_ + proposed > t_))
      throw numerical_error(
          "the time step does not advance time (it is not positive, or smaller than the "
          "rounding of t)",
          {n_, static_cast<double>(t_), -1, static_cast<double>(proposed)});
    return proposed;
  }

  void advance(Real dt) {
    ++n_;
    if (fixed_) {
      t_ = n_ >= count_ ? t1_ : t0_ + Real(n_) * *fixed_;
      return;
    }
    // While dt stays the same, t is a multiple of it from where it began to be so.
    if (dt != anchor_dt_) {
      anchor_ = t_;
      anchor_dt_ = dt;
      since_anchor_ = 0;
    }
    ++since_anchor_;
    t_ = anchor_ + Real(since_anchor_) * anchor_dt_;
    // What rounding of t leaves is not a step.
    using std::abs;
    if (t_ >= t1_ || t1_ - t_ <= Real(8) * std::numeric_limits<Real>::epsilon() * (abs(t1_) + abs(t0_)))
      t_ = t1_;
  }

  /// Goes to where an earlier run stopped.
  void resume(const progress& saved) {
    n_ = saved.step;
    t_ = saved.t;
    anchor_ = saved.anchor;
    anchor_dt_ = saved.anchor_dt;
    since_anchor_ = saved.since_anchor;
  }
  progress save() const { return {n_, since_anchor_, t_, anchor_, anchor_dt_}; }

 private:
  Real t0_, t1_, t_;
  Real anchor_ = Real(0), anchor_dt_ = Real(-1);
  long since_anchor_ = 0;
  std::optional<Real> fixed_;
  long n_ = 0, count_ = 0;
  bool adjusted_ = false;
};

/// What an integration did.
template <class Real>
struct integration_result {
  Real t;
  long steps;
  Real dt;  ///< of the last full-length step; 0 if there was none
};

/// Observer that sees nothing.
struct no_observer {
  template <class... Args>
  void operator()(Args&&...) const {}
};

/// Integrates u from t0 to t1. observer(step, t, dt, u) is called for the initial state (step 0, dt 0) and
/// after every step; if it returns bool, false ends the integration. A numerical_error leaves with step and
/// time; u is then the last good state.
template <problem P, class Observer = no_observer>
integration_result<typename P::real> integrate(stepper<P>& method_stepper, typename P::state& u,
                                               typename P::real t0, typename P::real t1,
                                               step_rule<typename P::real> rule, Observer&& observer = {}) {
  using real = typename P::real;
  time_marcher<real> march(t0, t1, rule.dt);
  real longest(0);
  const auto report = [&](real dt) {
    if constexpr (std::is_convertible_v<decltype(observer(0L, t0, dt, u)), bool>) {
      return static_cast<bool>(observer(march.step(), march.t(), dt, u));
    } else {
      observer(march.step(), march.t(), dt, u);
      return true;
    }
  };
  bool wanted = report(real(0));
  while (wanted && !march.done()) {
    try {
      const real limit = rule.dt ? *rule.dt
                                 : rule.safety * method_stepper.r() *
                                       method_stepper.target_problem().forward_euler_step(march.t(), u);
      const real dt = march.next(limit);
      method_stepper.step(march.t(), dt, u);
      march.advance(dt);
      longest = longest > dt ? longest : dt;
      wanted = report(dt);
    } catch (const numerical_error& failure) {
      throw failure.site().step >= 0 ? failure : failure.at(march.step(), static_cast<double>(march.t()));
    }
  }
  return {march.t(), march.step(), longest};
}

}  // namespace apsis
