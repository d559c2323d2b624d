#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/graded_start.hpp>
#include <apsis/integrate/stepper.hpp>

#include <cmath>
#include <limits>
#include <optional>

namespace apsis {

/// The first step as it is, or cut into steps that double and resolve the initial layer of data out of
/// equilibrium (graded_start): for methods that violate (N3) of docs/plateaus.md.
enum class startup { none, graded };

/// How long a step is: a given dt, or Δt = safety · r · Δt_FE (safety ≤ 1 keeps what forward Euler keeps).
template <class Real>
struct step_rule {
  std::optional<Real> dt;         ///< the given length; the other rule without one
  Real safety = Real(1);          ///< of no meaning where dt is given
  startup start = startup::none;  ///< of the first step

  /// Steps of length dt.
  static step_rule fixed(Real dt) { return {dt, Real(1), startup::none}; }
  /// Steps of safety · r · Δt_FE. For methods with an SSP coefficient (stepper::ssp_coefficient()).
  static step_rule ssp(Real safety = Real(1)) { return {std::nullopt, safety, startup::none}; }
  /// Steps of any length, for integrate_to_tolerance().
  static step_rule unlimited() { return fixed(std::numeric_limits<Real>::infinity()); }
  /// The same with another start.
  step_rule with(startup how) const { return {dt, safety, how}; }
};

/// The largest whole k ≥ 0 with k · every ≤ t, where the product is the rounded one: a time that was set to
/// k · every counts as reached. 0 where t < every.
template <class Real>
long multiples_until(Real t, Real every) {
  using std::floor;
  if (!(t >= every)) return 0;
  auto k = static_cast<long>(floor(t / every));
  while (Real(k + 1) * every <= t) ++k;
  while (Real(k) * every > t) --k;
  return k;
}

/// Time from t0 to t1 in steps. With a given dt times are t0 + n dt (no accumulation of rounding); a dt that
/// does not divide t1 − t0 (to 1e-12) is reduced until it does, see adjusted(). Without one, the last step is
/// shortened to meet t1, and steps are shortened to meet the times of stop_every(). An interval of length
/// zero has no steps. A start-up puts times between the first two and changes no other, unless the rule
/// shortens steps on the way.
template <class Real>
class time_marcher {
 public:
  /// All that changes on the way, so that a restart goes on to the same last digit.
  struct progress {
    long step,                      ///< steps taken
        since_anchor;               ///< of them of length anchor_dt at the end
    Real t,                         ///< time reached
        anchor,                     ///< time from which on steps have the length anchor_dt
        anchor_dt;                  ///< −1 before the first step, and where dt was given
    long startup_steps = 0,         ///< into which the first step is cut
        startup_done = 0;           ///< of them
    Real startup_length = Real(0);  ///< of the first step before it was cut
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
      // A dt that divides up to rounding is kept, so that steps do not depend on where the interval ends.
      if (abs(nearest * *dt - length) > Real(4) * std::numeric_limits<Real>::epsilon() * length)
        fixed_ = length / Real(count_);
    }
  }

  /// Some step ends at every time k · every in the interval, to the last digit (k = 1, 2, …; 0 ends the
  /// wish). A given dt must divide `every` to 1e-12: input_error otherwise. The last two steps before such a
  /// time are of equal length where one alone would be a sliver.
  void stop_every(Real every) {
    using std::abs, std::round;
    if (!(every >= Real(0))) throw input_error("times to stop at are negative or NaN; give an interval ≥ 0");
    if (fixed_ && count_ > 0 && every > Real(0)) {
      const Real ratio = every / *fixed_;
      if (ratio < Real(0.5) || abs(ratio - round(ratio)) > Real(1e-12) * ratio)
        throw input_error(
            "dt does not divide the interval between the times to stop at; give one that does, or no dt");
    }
    every_ = every;
  }

  /// Cuts the first step, whose length the rule `proposed`, into steps that double from relaxation_time/4 on;
  /// both as long as the interval at most. Nothing happens after the first step, or where there is none.
  void start_up(Real proposed, Real relaxation_time) {
    if (n_ > 0 || done()) return;
    startup_length_ = next(proposed);
    startup_steps_ = graded_levels(startup_length_, Real(relaxation_time / 4)) + 1;
  }
  /// The next step is one of those.
  bool starting() const { return startup_done_ < startup_steps_; }
  /// Their number; 1 if the first step is short enough, 0 without start-up. A rule that shortens steps on the
  /// way ends the start-up.
  long startup_steps() const { return startup_steps_; }
  /// The steps after this one, if all are as long as `full`; the start-up counts with its own.
  long steps_left(Real full) const {
    using std::ceil;
    const Real from = starting() ? t0_ + startup_length_ : t_;
    return startup_steps_ - startup_done_ + static_cast<long>(ceil((t1_ - from) / full - Real(1e-9)));
  }

  /// The end t1 is reached.
  bool done() const { return fixed_ ? whole_steps() >= count_ : !(t_ < t1_); }
  Real t() const { return t_; }     ///< time reached
  long step() const { return n_; }  ///< steps taken
  /// The given dt did not divide the interval.
  bool adjusted() const { return adjusted_; }
  /// The given dt after adjustment.
  std::optional<Real> fixed_dt() const { return fixed_; }

  /// The length of the next step, where `proposed` is what the rule allows (ignored if dt was given).
  /// Throws input_error if nothing limits it, numerical_error if it does not advance time.
  Real next(Real proposed) const {
    using std::isinf;
    if (starting() && (fixed_ || startup_step() <= proposed)) return startup_step();
    if (fixed_) return *fixed_;
    if (isinf(proposed) && proposed > Real(0))
      throw input_error(
          "nothing limits the time step (the transport sets no forward Euler step, or the method is "
          "unconditionally stable); give dt");
    const Real stop = next_stop(), rest = t1_ - t_;
    if (stop > Real(0) && stop - t_ < Real(2) * proposed) {
      if (stop - t_ > proposed + rounding(stop)) return (stop - t_) / Real(2);
      return stop - t_ < proposed ? stop - t_ : proposed;
    }
    if (rest < proposed) return rest;
    if (!(t_ + proposed > t_))
      throw numerical_error(
          "the time step does not advance time (it is not positive, or smaller than the "
          "rounding of t)",
          {n_ + 1, static_cast<double>(t_), -1, static_cast<double>(proposed)});
    return proposed;
  }

  /// Whether the next step would be another one, in its length or its end, if t1 were later: a run that may
  /// be continued to a later t1 is saved before it.
  bool shaped_by_end(Real proposed) const {
    if (done()) return false;
    time_marcher longer = *this, here = *this;
    if (fixed_) {
      // t0 + n dt may differ from t1 by rounding.
      if (whole_steps() + 1 < count_ || starting()) return false;
      longer.count_ = count_ + 1;
    }
    // Late enough for no step to meet it.
    longer.t1_ = t1_ + Real(4) * (proposed + (t1_ - t_) + every_);
    const Real dt = next(proposed);
    if (longer.next(proposed) != dt) return true;
    longer.advance(dt);
    here.advance(dt);
    return here.t_ != longer.t_;
  }

  /// A step of the length dt that next() gave has been taken.
  void advance(Real dt) {
    const Real stop = next_stop();
    move(dt);
    meet(stop);
  }

  /// Goes to where an earlier run stopped.
  void resume(const progress& saved) {
    n_ = saved.step;
    t_ = saved.t;
    anchor_ = saved.anchor;
    anchor_dt_ = saved.anchor_dt;
    since_anchor_ = saved.since_anchor;
    startup_steps_ = saved.startup_steps;
    startup_done_ = saved.startup_done;
    startup_length_ = saved.startup_length;
  }
  /// For a checkpoint.
  progress save() const {
    return {n_, since_anchor_, t_, anchor_, anchor_dt_, startup_steps_, startup_done_, startup_length_};
  }

 private:
  void move(Real dt) {
    ++n_;
    if (starting() && (fixed_ || dt == startup_step())) {
      ++startup_done_;
      t_ = t0_ + halved(startup_length_, startup_steps_ - startup_done_);
      if (starting()) return;
      // From here on as after one step of the whole length.
      t_ = t0_;
      dt = startup_length_;
    } else {
      startup_steps_ = startup_done_;
    }
    if (fixed_) {
      t_ = whole_steps() >= count_ ? t1_ : t0_ + Real(whole_steps()) * *fixed_;
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
    if (t_ >= t1_ || t1_ - t_ <= rounding(t1_)) t_ = t1_;
  }
  /// t is set to the time that a step was to end at.
  void meet(Real stop) {
    using std::abs;
    if (!(stop > Real(0)) || t_ == t1_) return;
    if (fixed_ ? abs(stop - t_) <= Real(2e-12) * stop && abs(stop - t_) < *fixed_ / Real(4)
               : t_ >= stop || stop - t_ <= rounding(stop))
      t_ = stop;
  }
  Real rounding(Real t) const {
    using std::abs;
    return Real(8) * std::numeric_limits<Real>::epsilon() * (abs(t) + abs(t0_));
  }
  /// The next time to stop at before t1; 0 if there is none.
  Real next_stop() const {
    if (!(every_ > Real(0))) return Real(0);
    const Real stop = Real(multiples_until(t_, every_) + 1) * every_;
    return stop < t1_ - rounding(t1_) ? stop : Real(0);
  }

  Real startup_step() const { return graded_step(startup_length_, startup_steps_ - 1, startup_done_); }
  /// Steps of full length that are done; the start-up is one of them.
  long whole_steps() const {
    if (startup_steps_ == 0) return n_;
    return starting() ? 0 : n_ - (startup_steps_ - 1);
  }

  Real t0_, t1_, t_;
  Real anchor_ = Real(0), anchor_dt_ = Real(-1);
  long since_anchor_ = 0;
  long startup_steps_ = 0, startup_done_ = 0;
  Real startup_length_ = Real(0);
  Real every_ = Real(0);
  std::optional<Real> fixed_;
  long n_ = 0, count_ = 0;
  bool adjusted_ = false;
};

/// What an integration did.
template <class Real>
struct integration_result {
  Real t;              ///< time reached: t1, or where the observer ended it
  long steps;          ///< number of steps, those of a start-up included
  Real dt;             ///< longest step; 0 if there was none
  long startup_steps;  ///< that took the place of the first; 0 without start-up
};

/// Observer that sees nothing.
struct no_observer {
  /// Nothing.
  template <class... Args>
  void operator()(Args&&...) const {}
};

/// What the rule allows a step from u at t. Throws input_error if the rule is ssp() and the method has no SSP
/// coefficient.
template <problem P>
typename P::real rule_limit(stepper<P>& method_stepper, const step_rule<typename P::real>& rule,
                            typename P::real t, const typename P::state& u) {
  if (rule.dt) return *rule.dt;
  return rule.safety * method_stepper.require_ssp_coefficient() *
         method_stepper.target_problem().forward_euler_step(t, u);
}

/// Width ε/C of the initial layer of u. Throws input_error if the problem has no relaxation_time.
template <problem P>
typename P::real initial_layer(P& p, typename P::real t, const typename P::state& u) {
  if constexpr (problem_with_relaxation_time<P>) {
    return p.relaxation_time(t, u);
  } else {
    throw input_error(
        "a graded start needs the width of the initial layer (the problem has no relaxation_time(t, u)); "
        "offer it, or start without");
  }
}

/// Integrates u along `march`; take(march, limit, u) takes one step within what the rule allows and returns
/// its length, without moving the marcher.
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
    march.start_up(limit(), initial_layer(method_stepper.target_problem(), march.t(), u));
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
/// after every step; if it returns bool, false ends the integration. A numerical_error leaves with step and
/// time; u is then the last good state. A graded start-up needs a problem_with_relaxation_time: input_error
/// otherwise.
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
  return integrate_with(take, method_stepper, time_marcher<real>(t0, t1, rule.dt), u, rule, observer);
}

}  // namespace apsis
