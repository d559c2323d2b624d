#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/integrate.hpp>

#include <algorithm>
#include <concepts>
#include <string>

namespace apsis {

/// Position of a formula in its history, the values that it stores between steps.
template <class Real>
struct history_position {
  Real dt{};       ///< length of its steps
  long known = 0;  ///< number of values in it

  /// Calls visit(name, member) for every member of `self`.
  template <class Self, class Visitor>
  static void visit_members(Self& self, Visitor&& visit) {
    visit("dt", self.dt);
    visit("known", self.known);
  }
};

/// A formula of several equal steps. add(t, Δt, u) records a value of the start-up, Δt after the last one.
/// step(t, Δt, u) requires first_steps() − 1 such values before u. known() counts these values, and restart()
/// discards them.
template <class Formula>
concept equal_step_formula = requires(Formula f, typename Formula::real t, typename Formula::state u) {
  { f.first_steps() } -> std::convertible_to<int>;
  { f.name() } -> std::convertible_to<std::string>;
  f.starter();
  f.add(t, t, u);
  f.step(t, t, u);
  f.restart();
  { f.known() } -> std::convertible_to<long>;
};

/// Integrates u from t0 to t1 with equal steps, like integrate() with a stepper; a graded start divides the
/// first of them. The first steps are those of the starter. Throws input_error if the rule has no dt: the
/// formula holds for equal steps only.
template <equal_step_formula Formula, class Observer = no_observer>
integration_result<typename Formula::real> integrate(Formula& formula, typename Formula::state& u,
                                                     typename Formula::real t0, typename Formula::real t1,
                                                     step_rule<typename Formula::real> rule,
                                                     Observer&& observer = {}) {
  using real = typename Formula::real;
  if (!rule.dt)
    throw input_error(formula.name() +
                      " needs equal steps (its coefficients depend on earlier steps); give dt");
  formula.restart();
  const auto take = [&](const time_marcher<real>& march, real limit, typename Formula::state& state) {
    const real dt = march.next(limit), t = march.t();
    // Start-up steps count as one step.
    const long whole = march.step() - std::max(0L, march.startup_steps() - 1);
    if (!march.starting() && whole >= formula.first_steps()) {
      formula.step(t, dt, state);
    } else {
      if (!march.starting() && whole > 0) formula.add(t, dt, state);
      formula.starter().step(t, dt, state);
    }
    return dt;
  };
  return integrate_with(take, formula.starter(), time_marcher<real>(t0, t1, rule.dt, rule.growth), u, rule,
                        observer);
}

}  // namespace apsis
