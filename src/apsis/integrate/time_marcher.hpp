#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/core/graded_start.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace apsis {

/// Returns the largest integer k ≥ 0 with fl(k · every) ≤ t, so that a time set to k · every counts as
/// reached; 0 if t < every.
template <class Real>
long multiples_until(Real t, Real every) {
  using std::floor;
  if (!(t >= every)) return 0;
  auto k = static_cast<long>(floor(t / every));
  while (Real(k + 1) * every <= t) ++k;
  while (Real(k) * every > t) --k;
  return k;
}

/// Divides the time from t0 to t1 into steps. With a given dt, times are t0 + n dt, so that rounding errors
/// do not accumulate. A dt that does not divide t1 − t0 to within 1e-12 is reduced until it does, see
/// adjusted(). Otherwise the rule limits the steps. They divide the time to the next stop of stop_every()
/// evenly, and the last shared_steps divide the time to t1 evenly: no much shorter step remains. An interval
/// of length zero has no steps. A graded start-up divides the first step. It changes no later time, unless
/// the rule shortens steps during it.
template <class Real>
class time_marcher {
 public:
  /// State of the marcher in a checkpoint; a restart from it is bitwise identical.
  struct progress {
    long step = 0,                  ///< steps taken
        since_anchor = 0;           ///< steps of length anchor_dt since `anchor`
    Real t{},                       ///< time reached
        anchor{},                   ///< time since which all steps have the length anchor_dt
        anchor_dt{};                ///< −1 before the first step and for a given dt
    long startup_steps = 0,         ///< number of steps that replace the first one
        startup_done = 0;           ///< number of these that are done
    Real startup_length = Real(0);  ///< length of the first step before it was divided

    /// Calls visit(name, member) for every member of `self`.
    template <class Self, class Visitor>
    static void visit_members(Self& self, Visitor&& visit) {
      visit("step", self.step);
      visit("since_anchor", self.since_anchor);
      visit("t", self.t);
      visit("anchor", self.anchor);
      visit("anchor_dt", self.anchor_dt);
      visit("startup_steps", self.startup_steps);
      visit("startup_done", self.startup_done);
      visit("startup_length", self.startup_length);
    }
  };

  /// Number of steps before t1 that share its remainder. Each is shortened by 1/64 at most. Earlier steps do
  /// not depend on t1, so that a run can be continued to a later t1.
  static constexpr long shared_steps = 64;

  /// `growth` is the ratio of the times of a graded start-up. Throws input_error unless t0 ≤ t1 are finite,
  /// dt > 0 is finite, the interval has at most 1e15 steps, and growth is from 2 to largest_growth.
  time_marcher(Real t0, Real t1, std::optional<Real> dt = std::nullopt, int growth = default_growth)
      : t0_(t0), t1_(t1), t_(t0), growth_(growth), fixed_(dt) {
    using std::isfinite, std::abs, std::ceil, std::round;
    if (!isfinite(t0) || !isfinite(t1) || t1 < t0)
      throw input_error(
          "the time interval does not exist (its end lies before its start, or is not finite); "
          "give finite t0 ≤ t1");
    if (growth < 2 || growth > largest_growth)
      throw input_error("the growth of a graded start is " + std::to_string(growth) +
                        " (the ratio of its times is from 2 to " + std::to_string(largest_growth) +
                        "); give one in this range");
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
      // Keep a dt that divides the interval up to rounding, so that steps do not depend on t1.
      if (abs(nearest * *dt - length) > Real(4) * std::numeric_limits<Real>::epsilon() * length)
        fixed_ = length / Real(count_);
    }
  }

  /// Makes a step end exactly at every time k · every in the interval (k = 1, 2, …); every = 0 removes the
  /// stops. Steps of a rule with constant limit then have equal length. Throws input_error if `every` is
  /// negative or NaN, or if a given dt does not divide it to within 1e-12.
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

  /// Divides the first step, of the length `proposed` by the rule, into graded steps. The first of these is
  /// at most longest_first_step(relaxation_time); both are limited by the interval. Has no effect after the
  /// first step, or if there is no step.
  void start_up(Real proposed, Real relaxation_time) {
    if (n_ > 0 || done()) return;
    startup_length_ = next(proposed);
    // The end does not shorten the start-up, unless it is the only step: a run to a later end has the same
    // start-up.
    if (!fixed_)
      startup_length_ =
          std::min(every_ > Real(0) ? equal_part(next_multiple(), proposed) : proposed, t1_ - t_);
    startup_steps_ =
        graded_levels(startup_length_, longest_first_step(relaxation_time, growth_), growth_) + 1;
  }
  /// Whether the next step is part of the start-up.
  bool starting() const { return startup_done_ < startup_steps_; }
  /// Returns the number of start-up steps: 1 if the first step is short enough, 0 without start-up. The
  /// start-up ends early if the rule shortens its steps.
  long startup_steps() const { return startup_steps_; }
  /// Returns the number of steps left if all have the length `full`; start-up steps keep their lengths.
  long steps_left(Real full) const {
    using std::ceil;
    const Real from = starting() ? t0_ + startup_length_ : t_;
    return startup_steps_ - startup_done_ + static_cast<long>(ceil((t1_ - from) / full - Real(1e-9)));
  }

  /// Whether t1 is reached.
  bool done() const { return fixed_ ? whole_steps() >= count_ : !(t_ < t1_); }
  Real t() const { return t_; }     ///< time reached
  long step() const { return n_; }  ///< steps taken
  /// Whether the given dt did not divide the interval and was reduced.
  bool adjusted() const { return adjusted_; }
  /// Returns the given dt after adjustment.
  std::optional<Real> fixed_dt() const { return fixed_; }

  /// Returns the length of the next step; `proposed` is the limit by the rule (ignored if dt was given).
  /// Throws input_error if the step is unlimited, numerical_error if it does not advance time.
  Real next(Real proposed) const {
    using std::isinf;
    if (starting() && (fixed_ || startup_step() <= proposed)) return startup_step();
    if (fixed_) return *fixed_;
    if (isinf(proposed) && proposed > Real(0))
      throw input_error(
          "nothing limits the time step (the transport sets no forward Euler step, or the method is "
          "unconditionally stable); give dt");
    // Halves of a subnormal step are 0: time would not advance, and no check would detect this.
    if (!(t_ + proposed > t_) || proposed < std::numeric_limits<Real>::min())
      throw numerical_error(
          "the time step does not advance time (it is not positive, or smaller than the rounding of t); "
          "check the forward Euler step and the tolerance",
          {n_ + 1, static_cast<double>(t_), -1, static_cast<double>(proposed)});
    const Real stop = every_ > Real(0) ? next_multiple() : t1_;
    if (every_ > Real(0) && stop <= t1_ + rounding(t1_)) return equal_part(std::min(stop, t1_), proposed);
    if (t1_ - t_ < Real(shared_steps) * proposed) return equal_part(t1_, proposed);
    return every_ > Real(0) ? equal_part(stop, proposed) : proposed;
  }

  /// Whether the length or end of the next step depends on t1. A run that may be extended to a later t1 is
  /// saved before this step.
  bool shaped_by_end(Real proposed) const {
    if (done()) return false;
    if (!fixed_ && starting() && !(startup_length_ < t1_ - t0_)) return true;  // the only step
    time_marcher longer = *this, here = *this;
    if (fixed_) {
      // The last time is t1, which may differ from t0 + n dt by rounding.
      if (whole_steps() + 1 < count_ || starting()) return false;
      longer.count_ = count_ + 1;
    }
    // An end that is late enough not to affect the next step.
    longer.t1_ = t1_ + Real(4) * (Real(shared_steps) * proposed + (t1_ - t_) + every_);
    const Real dt = next(proposed);
    if (longer.next(proposed) != dt) return true;
    longer.advance(dt);
    here.advance(dt);
    return here.t_ != longer.t_;
  }

  /// Records a step of the length dt that next() returned.
  void advance(Real dt) {
    const Real stop = next_stop();
    move(dt);
    snap_to(stop);
  }

  /// Restores the state of an earlier run.
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
  /// Returns the state for a checkpoint.
  progress save() const {
    return {n_, since_anchor_, t_, anchor_, anchor_dt_, startup_steps_, startup_done_, startup_length_};
  }

 private:
  void move(Real dt) {
    ++n_;
    if (starting() && (fixed_ || dt == startup_step())) {
      ++startup_done_;
      t_ = t0_ + graded_time(startup_length_, startup_steps_ - 1, startup_done_ - 1, growth_);
      if (starting()) return;
      // The last start-up step completes one step of full length.
      t_ = t0_;
      dt = startup_length_;
    } else {
      startup_steps_ = startup_done_;
    }
    if (fixed_) {
      t_ = whole_steps() >= count_ ? t1_ : t0_ + Real(whole_steps()) * *fixed_;
      return;
    }
    // While dt does not change, t is the anchor plus a multiple of dt.
    if (dt != anchor_dt_) {
      anchor_ = t_;
      anchor_dt_ = dt;
      since_anchor_ = 0;
    }
    ++since_anchor_;
    t_ = anchor_ + Real(since_anchor_) * anchor_dt_;
    // A remainder of the size of rounding errors is not a step.
    if (t_ >= t1_ || t1_ - t_ <= rounding(t1_)) t_ = t1_;
  }
  /// Returns the length of the fewest equal steps that reach `target` within the limit `proposed`. If it
  /// differs from the last length by rounding alone, returns the last length.
  Real equal_part(Real target, Real proposed) const {
    using std::abs, std::ceil;
    const Real rest = target - t_, allowed = rounding(target);
    const Real steps = std::max(Real(1), Real(ceil((rest - allowed) / proposed)));
    const Real part = rest / steps;
    if (anchor_dt_ > Real(0) && anchor_dt_ <= proposed && abs(part - anchor_dt_) * steps <= allowed)
      return anchor_dt_;
    return part < proposed ? part : proposed;
  }
  /// Sets t to the stop at which the step was to end.
  void snap_to(Real stop) {
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
  /// Returns the first k · every after t.
  Real next_multiple() const { return Real(multiples_until(t_, every_) + 1) * every_; }
  /// Returns the next stop before t1; 0 without one.
  Real next_stop() const {
    if (!(every_ > Real(0))) return Real(0);
    const Real stop = next_multiple();
    return stop < t1_ - rounding(t1_) ? stop : Real(0);
  }

  Real startup_step() const {
    return graded_step(startup_length_, startup_steps_ - 1, startup_done_, growth_);
  }
  /// Returns the number of completed steps of full length; the start-up counts as one.
  long whole_steps() const {
    if (startup_steps_ == 0) return n_;
    return starting() ? 0 : n_ - (startup_steps_ - 1);
  }

  Real t0_, t1_, t_;
  Real anchor_ = Real(0), anchor_dt_ = Real(-1);
  long since_anchor_ = 0;
  long startup_steps_ = 0, startup_done_ = 0;
  Real startup_length_ = Real(0);
  int growth_;
  Real every_ = Real(0);
  std::optional<Real> fixed_;
  long n_ = 0, count_ = 0;
  bool adjusted_ = false;
};

}  // namespace apsis
