#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/any_stepper.hpp>
#include <apsis/integrate/equal_steps.hpp>
#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/integrate.hpp>
#include <apsis/integrate/step_estimate.hpp>
#include <apsis/method/time_integrator.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

namespace apsis {

/// Tolerance of the estimated error of a step.
template <class State, class Real>
struct step_tolerance {
  Real tolerance;  ///< largest accepted distance
  /// Returns a norm of u − v, which may be relative to u.
  std::function<Real(const State& u, const State& v)> distance;
};

/// @cond
namespace evolution_parts {

/// Integrates over one interval by a method of any kind.
template <class State, class Real>
class any_march {
 public:
  using observer = std::function<bool(long, Real, Real, const State&)>;
  virtual ~any_march() = default;
  virtual void integrate_to(Real t0, Real t1, State& u, const step_rule<Real>& rule,
                            const observer& observe) = 0;
  virtual long rejected() const = 0;
};

/// A method of one step.
template <class March, class State, class Real>
class independent_march final : public any_march<State, Real> {
 public:
  using tolerance = step_tolerance<State, Real>;
  independent_march(March march, const std::optional<tolerance>& tolerated, int order)
      : march_(std::move(march)), tolerated_(tolerated) {
    if (tolerated) control_.emplace(tolerated->tolerance, order);
  }

  void integrate_to(Real t0, Real t1, State& u, const step_rule<Real>& rule,
                    const typename any_march<State, Real>::observer& observe) override {
    if (control_)
      integrate_to_tolerance(march_, u, t0, t1, rule, *control_, tolerated_->distance, observe);
    else
      integrate(march_, u, t0, t1, rule, observe);
  }
  long rejected() const override { return control_ ? control_->rejected() : 0; }

 private:
  March march_;
  std::optional<tolerance> tolerated_;
  std::optional<step_controller<Real>> control_;
};

/// A formula of several equal steps.
template <class March, class State, class Real>
class dependent_march final : public any_march<State, Real> {
 public:
  explicit dependent_march(March march) : march_(std::move(march)) {}

  void integrate_to(Real t0, Real t1, State& u, const step_rule<Real>& rule,
                    const typename any_march<State, Real>::observer& observe) override {
    integrate(march_, u, t0, t1, rule, observe);
  }
  long rejected() const override { return 0; }

 private:
  March march_;
};

}  // namespace evolution_parts
/// @endcond

/// A solution that advances from one time to the next by an integrator of any kind, with the steps that
/// integrate() and integrate_to_tolerance() take over each interval, bit for bit. The controller of the steps
/// continues from one interval to the next; a formula of several equal steps begins each with its starter.
template <problem P>
class evolution {
 public:
  using state = typename P::state;                ///< type of u
  using real = typename P::real;                  ///< type of time and coefficients
  using tolerance = step_tolerance<state, real>;  ///< error control
  /// Observes (step, t, dt, u) after a step; false ends the interval there. Steps count from 1 since start().
  using observer = std::function<bool(long step, real t, real dt, const state& u)>;

  /// Stores a reference to the problem, which must outlive this object. `rule` limits the steps, also with a
  /// tolerance; its start-up divides the first step after start(). Throws input_error if the problem lacks
  /// what the method needs, or if a tolerance is given for a method that needs equal steps.
  evolution(const time_integrator& m, P& p, step_rule<real> rule,
            const std::optional<tolerance>& tolerated = std::nullopt)
      : rule_(rule) {
    if (tolerated && m.one_step() == nullptr)
      throw input_error(
          "the steps of '" + m.name +
          "' cannot follow a tolerance (it needs equal steps); give dt alone, or choose a method "
          "of one step");
    const int order = tolerated ? estimate_of(*m.one_step()).order : 0;
    march_ = with_stepper(
        m, p,
        [&](auto march) -> std::unique_ptr<evolution_parts::any_march<state, real>> {
          using March = decltype(march);
          if constexpr (equal_step_formula<March>)
            return std::make_unique<evolution_parts::dependent_march<March, state, real>>(std::move(march));
          else
            return std::make_unique<evolution_parts::independent_march<March, state, real>>(std::move(march),
                                                                                            tolerated, order);
        },
        tolerated ? solutions::result_and_embedded : solutions::result);
  }

  /// Sets time and state. Throws input_error if t is not finite.
  void start(real t, state u) {
    using std::isfinite;
    if (!isfinite(t)) throw input_error("the initial time is not finite; give a number");
    t_ = t;
    u_ = std::move(u);
    steps_ = 0;
  }

  /// Integrates from the time reached to t1. Returns whether t1 is reached: false if the observer ended the
  /// integration. Throws like integrate(), time and state then being those of the last accepted step.
  /// Requires start().
  bool advance(real t1, const observer& observe = {}) {
    const step_rule<real> rule = steps_ == 0 ? rule_ : rule_.with(startup::none);
    bool wanted = true;
    const auto each = [&](long step, real t, real dt, const state& u) {
      if (step == 0) return true;  // the state before the first step
      t_ = t;
      ++steps_;
      wanted = !observe || observe(steps_, t, dt, u);
      return wanted;
    };
    try {
      march_->integrate_to(t_, t1, u_, rule, each);
    } catch (const numerical_error& failure) {
      throw failure.at(steps_ + 1, static_cast<double>(t_));  // steps count from start()
    }
    return wanted;
  }

  real t() const { return t_; }                         ///< time reached
  const state& u() const { return u_; }                 ///< state at t()
  long steps() const { return steps_; }                 ///< accepted steps since start()
  long rejected() const { return march_->rejected(); }  ///< rejected steps, since the constructor

 private:
  step_rule<real> rule_;
  std::unique_ptr<evolution_parts::any_march<state, real>> march_;
  real t_ = std::numeric_limits<real>::quiet_NaN();
  state u_{};
  long steps_ = 0;
};

}  // namespace apsis
