#pragma once

#include <apsis/integrate/any_stepper.hpp>
#include <apsis/integrate/equal_steps.hpp>
#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/integrate.hpp>
#include <apsis/integrate/step_estimate.hpp>
#include <apsis/method/step_law.hpp>
#include <apsis/method/time_integrator.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace apsis {

/// Tolerance of the estimated error of a step.
template <class State, class Real>
struct step_tolerance {
  Real tolerance;  ///< largest accepted distance
  /// Returns a norm of u − v, which may be relative to u.
  std::function<Real(const State& u, const State& v)> distance;
  std::optional<Real> first_step{};  ///< longest first step; without it first_step_length() alone sets it
  std::string controller{usual_step_law};  ///< name of the step_law
};

/// Integrates over intervals by a method of any kind, like integrate() and integrate_to_tolerance().
template <class State, class Real>
class any_march {
 public:
  /// Called with (step, t, dt, u) before the first step (step 0) and after every step; false ends the
  /// interval.
  using observer = std::function<bool(long, Real, Real, const State&)>;
  virtual ~any_march() = default;

  /// Advances u from t0 to t1. Throws like integrate() and integrate_to_tolerance().
  virtual void integrate_to(Real t0, Real t1, State& u, const step_rule<Real>& rule,
                            const observer& observe) = 0;
  /// Advances u from t by one step of length dt, without effect on later steps. It is a step of a method of
  /// one step, or of the starter of a formula of several steps. Throws what a step throws.
  virtual void part_of_step(Real t, Real dt, State& u) = 0;
  /// Returns the number of rejected steps.
  virtual long rejected() const = 0;
};

/// @cond
namespace any_march_parts {

/// A method of one step.
template <class March, class State, class Real>
class independent_march final : public any_march<State, Real> {
 public:
  using tolerance = step_tolerance<State, Real>;
  independent_march(March march, const std::optional<tolerance>& tolerated, int order)
      : march_(std::move(march)), tolerated_(tolerated) {
    if (!tolerated) return;
    if (!tolerated->distance)
      throw input_error(
          "the tolerance has no distance between states (it measures errors of steps); give a function");
    control_.emplace(tolerated->tolerance, order, find_step_law(tolerated->controller));
    if (tolerated->first_step) control_->start_with(*tolerated->first_step);
  }

  void integrate_to(Real t0, Real t1, State& u, const step_rule<Real>& rule,
                    const typename any_march<State, Real>::observer& observe) override {
    if (control_)
      integrate_to_tolerance(march_, u, t0, t1, rule, *control_, tolerated_->distance, observe);
    else
      integrate(march_, u, t0, t1, rule, observe);
  }
  void part_of_step(Real t, Real dt, State& u) override {
    if (!control_) return march_.step(t, dt, u);
    march_.attempt(t, dt, u);
    march_.accept(u);
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
  void part_of_step(Real t, Real dt, State& u) override { march_.starter().step(t, dt, u); }
  long rejected() const override { return 0; }

 private:
  March march_;
};

}  // namespace any_march_parts
/// @endcond

/// Returns the march of a method of one step, which need not be registered. `p` must outlive it. Throws
/// input_error if the problem lacks a function that the method needs, or a tolerance its distance.
template <problem P>
std::unique_ptr<any_march<typename P::state, typename P::real>> make_march(
    const method& m, P& p,
    const std::optional<step_tolerance<typename P::state, typename P::real>>& tolerated = std::nullopt) {
  using march = any_march_parts::independent_march<stepper<P>, typename P::state, typename P::real>;
  return std::make_unique<march>(
      stepper<P>(m, p, tolerated ? solutions::result_and_embedded : solutions::result), tolerated,
      tolerated ? estimate_of(m).order : 0);
}

/// Returns the march of an integrator. `p` must outlive it. Throws input_error if the problem lacks a
/// function that the method needs, or if a tolerance is given for a method that needs equal steps.
template <problem P>
std::unique_ptr<any_march<typename P::state, typename P::real>> make_march(
    const time_integrator& m, P& p,
    const std::optional<step_tolerance<typename P::state, typename P::real>>& tolerated = std::nullopt) {
  using state = typename P::state;
  using real = typename P::real;
  if (tolerated && m.one_step() == nullptr)
    throw input_error("the steps of '" + m.name +
                      "' cannot follow a tolerance (it needs equal steps); give dt alone, or choose a method "
                      "of one step");
  const int order = tolerated ? estimate_of(*m.one_step()).order : 0;
  return with_stepper(
      m, p,
      [&](auto march) -> std::unique_ptr<any_march<state, real>> {
        using March = decltype(march);
        if constexpr (equal_step_formula<March>)
          return std::make_unique<any_march_parts::dependent_march<March, state, real>>(std::move(march));
        else
          return std::make_unique<any_march_parts::independent_march<March, state, real>>(std::move(march),
                                                                                          tolerated, order);
      },
      tolerated ? solutions::result_and_embedded : solutions::result);
}

}  // namespace apsis
