#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/any_march.hpp>
#include <apsis/integrate/events.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis {

/// Why an evolution ended.
enum class evolution_end {
  reached,  ///< at the requested time
  stopped,  ///< the observer returned false
  event     ///< at an event
};

/// Throws input_error unless every time is finite and after the one before it.
template <class Real>
void require_increasing(const std::vector<Real>& times) {
  for (std::size_t i = 0; i < times.size(); ++i)
    if (!std::isfinite(times[i]) || (i > 0 && !(times[i - 1] < times[i])))
      throw input_error(fmt::format(
          "stop times do not increase (number {} is not finite, or not after the one before it); sort them",
          i));
}

/// A solution that advances from one time to the next by an integrator of any kind. Over each interval the
/// steps are those of integrate() or integrate_to_tolerance(), bit for bit. The controller of the steps
/// continues from one interval to the next; a formula of several equal steps begins each interval with its
/// starter.
///
/// Dense output: the solution at t + θ Δt inside the last step is that of a step of length θ Δt from its
/// beginning. It has the order p of the method and the properties that steps preserve for every Δt or for
/// short ones: positivity, bounds, conservation, the limit ε → 0. Each evaluation costs a step. At θ = 0 and
/// 1 it is the solution itself, bit for bit. For a formula of several equal steps the starter takes this
/// step, so that dense output jumps by the local error at θ = 1. Events are zeros of functions of this
/// solution, to rounding.
template <problem P>
class evolution {
 public:
  using state = typename P::state;                 ///< type of u
  using real = typename P::real;                   ///< type of time and coefficients
  using tolerance = step_tolerance<state, real>;   ///< error control
  using functions = event_functions<state, real>;  ///< events
  /// Observes (step, t, dt, u) after a step; false ends the integration there. Steps count from 1 since
  /// start().
  using observer = std::function<bool(long step, real t, real dt, const state& u)>;
  /// Observes an event of function k at t.
  using event_observer = std::function<void(std::size_t k, real t, const state& u)>;

  /// Stores a reference to the problem, which must outlive this object. `rule` limits the steps, also with a
  /// tolerance; its start-up divides the first step after start(). Throws like make_march().
  evolution(const time_integrator& m, P& p, step_rule<real> rule,
            const std::optional<tolerance>& tolerated = std::nullopt)
      : rule_(rule), march_(make_march(m, p, tolerated)) {}
  /// Uses a method of one step, which need not be registered, like the constructor above.
  evolution(const method& m, P& p, step_rule<real> rule,
            const std::optional<tolerance>& tolerated = std::nullopt)
      : rule_(rule), march_(make_march(m, p, tolerated)) {}

  /// Sets the functions of events, and the observers that are called at events in the order of time. Throws
  /// input_error if a list does not have an entry for each function, or if there is no function.
  void set_events(functions events, event_observer observe = {}) {
    if (events.count > 0 && !events.evaluate)
      throw input_error("the function of the events is empty (events are its zeros); give one");
    for (const std::size_t length : {events.directions.size(), events.ends.size()})
      if (length != 0 && length != events.count)
        throw input_error(
            fmt::format("a list of events has {} entries (there are {} functions); give one for each", length,
                        events.count));
    events_ = std::move(events);
    observe_event_ = std::move(observe);
  }

  /// Sets increasing times at which steps end exactly, such as discontinuities of T. Throws input_error if
  /// they do not increase or are not finite.
  void set_stops(std::vector<real> times) {
    require_increasing(times);
    stops_ = std::move(times);
  }

  /// Sets time and state, and discards events. Throws input_error if t is not finite.
  void start(real t, state u) {
    if (!std::isfinite(t))
      throw input_error("the initial time is not finite (steps begin there); give a number");
    t_ = before_t_ = t;
    u_ = std::move(u);
    steps_ = 0;
    found_.clear();
  }

  /// Integrates from the time reached to t1, or to the first event that ends the integration. Throws like
  /// integrate(); time and state are then those of the last accepted step. Throws input_error without
  /// start().
  evolution_end advance(real t1, const observer& observe = {}) {
    if (std::isnan(t_))
      throw input_error("the integration has no initial state (start() was not called); call it first");
    try {
      const auto first = std::upper_bound(stops_.begin(), stops_.end(), t_);
      for (auto stop = first; stop != stops_.end() && *stop < t1; ++stop) {
        const evolution_end end = advance_without_stops(*stop, observe);
        if (end != evolution_end::reached) return end;
      }
      return advance_without_stops(t1, observe);
    } catch (const numerical_error& failure) {
      throw failure.at(steps_ + 1, static_cast<double>(t_));  // steps count from start()
    }
  }

  /// Returns the solution at a time of the last step, by a step from its beginning: dense output. Throws
  /// input_error for other times, and what a step throws.
  state at(real t) {
    if (t == t_) return u_;
    if (!(t >= before_t_ && t < t_))
      throw input_error(fmt::format(
          "the time {:.10g} is not in the last step (from {:.10g} to {:.10g}); give one of this step",
          static_cast<double>(t), static_cast<double>(before_t_), static_cast<double>(t_)));
    return step_from(before_t_, before_, t);
  }

  /// Returns the solution at t of one step that begins with u at t0 ≤ t. This is at() for an earlier step,
  /// whose beginning the caller stored. Throws input_error for t < t0, and what a step throws.
  state step_from(real t0, state u, real t) {
    if (!(t0 <= t))
      throw input_error(
          fmt::format("the time {:.10g} is before the beginning of its step ({:.10g}); give a later one",
                      static_cast<double>(t), static_cast<double>(t0)));
    if (t > t0) march_->part_of_step(t0, t - t0, u);
    return u;
  }

  real t() const { return t_; }                         ///< time reached
  const state& u() const { return u_; }                 ///< state at t()
  real begin_of_step() const { return before_t_; }      ///< time before the last step; t() without one
  long steps() const { return steps_; }                 ///< accepted steps since start()
  long rejected() const { return march_->rejected(); }  ///< rejected steps, since the constructor
  const std::vector<found_event<real>>& found() const { return found_; }  ///< events since start()

 private:
  evolution_end advance_without_stops(real t1, const observer& observe) {
    const step_rule<real> rule = steps_ == 0 ? rule_ : rule_.with(startup::none);
    evolution_end end = evolution_end::reached;
    const auto each = [&](long step, real t, real dt, const state&) {
      if (step == 0) {
        last_ = u_;
        evaluate_events(t_, u_, g_);
        return true;
      }
      using std::swap;
      swap(before_, last_);
      before_t_ = t_;
      t_ = t;
      ++steps_;
      if (find_events()) end = evolution_end::event;
      if (t_ < t) dt = t_ - before_t_;
      if (observe && !observe(steps_, t_, dt, u_) && end == evolution_end::reached)
        end = evolution_end::stopped;
      if (end != evolution_end::reached) return false;
      last_ = u_;
      return true;
    };
    march_->integrate_to(t_, t1, u_, rule, each);
    return end;
  }

  void evaluate_events(real t, const state& u, std::vector<real>& g) const {
    if (events_.count == 0) return;
    g.resize(events_.count);
    events_.evaluate(t, u, g);
    for (std::size_t k = 0; k < g.size(); ++k) sign_of_event(k, g[k], t);  // throws for NaN
  }

  /// Finds the events of the last step, and ends the step at the first that ends the integration. Returns
  /// whether there is one.
  bool find_events() {
    if (events_.count == 0) return false;
    next_g_.clear();
    evaluate_events(t_, u_, next_g_);
    std::vector<found_event<real>> here;
    for (std::size_t k = 0; k < events_.count; ++k)
      if (events_.is_event(k, sign_of_event(k, g_[k], t_), sign_of_event(k, next_g_[k], t_)))
        here.push_back({k, time_of_event(k)});
    std::sort(here.begin(), here.end(), [](const auto& a, const auto& b) {
      return a.t < b.t || (a.t == b.t && a.function < b.function);
    });
    const auto last = std::find_if(here.begin(), here.end(),
                                   [this](const auto& one) { return events_.is_last(one.function); });
    const bool ends = last != here.end();
    const real end = ends ? last->t : t_;
    for (const auto& one : here) {
      if (one.t > end) break;
      found_.push_back(one);
      if (observe_event_) observe_event_(one.function, one.t, at(one.t));
    }
    if (end < t_) {
      u_ = at(end);
      t_ = end;
      evaluate_events(t_, u_, next_g_);
    }
    g_.swap(next_g_);
    return ends;
  }

  real time_of_event(std::size_t k) {
    std::vector<real> g;
    const auto value = [&](real t) {
      evaluate_events(t, at(t), g);
      return g[k];
    };
    // The precision of times: some roundings.
    const real width = real(100) * std::numeric_limits<real>::epsilon() * (std::abs(t_) + (t_ - before_t_));
    return time_after_sign_change(value, before_t_, g_[k], t_, next_g_[k], width);
  }

  step_rule<real> rule_;
  std::unique_ptr<any_march<state, real>> march_;
  functions events_;
  event_observer observe_event_;
  std::vector<real> stops_;
  real t_ = std::numeric_limits<real>::quiet_NaN(), before_t_ = t_;
  state u_{}, before_{},
      last_{};  ///< before_: at the beginning of the last step; last_: a copy of u_ for the next step
  std::vector<real> g_, next_g_;  ///< values of the event functions at t_
  std::vector<found_event<real>> found_;
  long steps_ = 0;
};

}  // namespace apsis
