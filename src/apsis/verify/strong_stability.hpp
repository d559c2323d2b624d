#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/exact_collisions.hpp>
#include <apsis/integrate/stepper.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/verify/step_search.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace apsis {

/// A property that a step from `before` to `after` should preserve. Dimensionless.
template <class State>
struct kept_property {
  std::string name;  ///< "total variation"
  /// Returns the violation beyond rounding: ≤ 0 if the step preserves the property; NaN counts as lost.
  std::function<double(const State& before, const State& after)> excess;
};

/// Returns the property that a convex functional Φ does not grow: Φ(after) ≤ Φ(before) +
/// rounding (1 + |Φ(before)|).
template <class State>
kept_property<State> does_not_grow(std::string name, std::function<double(const State&)> functional,
                                   double rounding = 1e-13) {
  return {std::move(name),
          [functional = std::move(functional), rounding](const State& before, const State& after) {
            const double start = functional(before);
            return functional(after) - start - rounding * (1.0 + std::abs(start));
          }};
}

/// Returns membership of a convex set, given by the distance of a state outside it (≤ 0 inside), as a
/// property: max(0, distance) ≤ rounding.
template <class State>
kept_property<State> stays_inside(std::string name, std::function<double(const State&)> distance,
                                  double rounding = 0.0) {
  return {std::move(name), [distance = std::move(distance), rounding](const State&, const State& after) {
            return distance(after) - rounding;
          }};
}

/// Returns r such that Δt ≤ r Δt_FE preserves what forward Euler steps preserve, from the certificate. These
/// are steps of the transport for IMEX methods, of T + Q for explicit ones. For implicit methods r is
/// infinity if the property is unconditional, otherwise the classical radius in forward Euler steps of Q.
double promised_coefficient(const certificate& c);

/// A problem with observed stages: `look(u)` is called with every stage value. For methods with exact
/// collisions, it uses the exact collisions of the problem, if they are known.
template <problem P>
class watched_problem {
 public:
  using state = typename P::state;  ///< state of the problem
  using real = typename P::real;    ///< number type of the problem
  /// Accumulators of add_transport().
  using targets_type = std::span<const target<state, real>>;

  /// `inner` must outlive this; `kind` is that of the method.
  watched_problem(P& inner, method_kind kind, std::function<void(const state&)> look)
      : inner_(inner),
        exact_(problem_with_known_collision<P> && solves_exactly(kind)),
        look_(std::move(look)) {}

  /// Forwards to the problem; observes u if T(u) is evaluated.
  void add_transport(real t, const state& u, targets_type targets) {
    // If only multiples of u are requested, u may be the explicit part of a stage.
    for (const auto& to : targets)
      if (to.beta != real(0)) {
        look_(u);
        break;
      }
    inner_.add_transport(t, u, targets);
  }
  /// Forwards to the problem and observes the solution.
  void solve_collision(real t, real a, real b, state& u) {
    if constexpr (problem_with_known_collision<P>) {
      if (exact_)
        inner_.advance_collision(t, a, u);
      else
        inner_.solve_collision(t, a, b, u);
    } else {
      inner_.solve_collision(t, a, b, u);
    }
    look_(u);
  }
  /// Forwards to the problem.
  void add_collision(real t, const state& u, targets_type targets)
    requires problem_with_explicit_collision<P>
  {
    inner_.add_collision(t, u, targets);
  }
  /// Returns Δt_FE of the problem.
  real forward_euler_step(real t, const state& u) const { return inner_.forward_euler_step(t, u); }
  /// Returns whether collisions are exact.
  bool collides_exactly() const { return exact_ || apsis::collides_exactly(inner_); }

 private:
  P& inner_;
  bool exact_;
  std::function<void(const state&)> look_;
};

/// Returns the largest Δt for which a method preserves a property in every one of `how.steps` steps from all
/// of the data. It is in units of Δt_FE, the smallest of the data (`how.unit` if T has none). Methods with
/// SSP coefficient r preserve what forward Euler steps preserve for Δt ≤ r Δt_FE. A smaller result therefore
/// refutes the method, the property or Δt_FE. A larger one means that the data are not the worst. A step that
/// ends with a numerical_error loses the property. Throws input_error without data or unit.
template <problem P>
step_limit largest_step(const method& m, P& equation, std::span<const typename P::state> data,
                        const kept_property<typename P::state>& property, const step_search& how = {}) {
  using state = typename P::state;
  using real = typename P::real;
  double unit = std::numeric_limits<double>::infinity();
  for (const state& u : data)
    unit = std::min(unit, static_cast<double>(equation.forward_euler_step(real(0), u)));
  const state* before = nullptr;
  double excess = 0.0;
  const auto judge = [&](const state& after) {
    const double found = property.excess(*before, after);
    if (!(found <= excess)) excess = found;
  };
  watched_problem<P> watched(equation, m.kind, [&](const state& stage) {
    if (how.stages) judge(stage);
  });
  stepper march(m, watched);
  return search_step(data.size(), unit, how, [&](std::size_t k, double dt) {
    state u = data[k], previous = u;
    before = &previous;
    excess = 0.0;
    try {
      for (int n = 0; n < how.steps && excess <= 0.0; ++n) {
        previous = u;
        march.step(real(n) * real(dt), real(dt), u);
        judge(u);
      }
    } catch (const numerical_error&) {
      return std::numeric_limits<double>::infinity();
    }
    return excess;
  });
}

/// Returns the largest τ for which u + τ T(u) preserves the property from all of the data: an upper
/// bound of Δt_FE. It is in units of the problem's own Δt_FE, so that a result below 1 refutes it.
/// Throws as largest_step does.
template <problem P>
step_limit largest_forward_euler_step(P& equation, std::span<const typename P::state> data,
                                      const kept_property<typename P::state>& property,
                                      const step_search& how = {}) {
  using state = typename P::state;
  using real = typename P::real;
  double unit = std::numeric_limits<double>::infinity();
  for (const state& u : data)
    unit = std::min(unit, static_cast<double>(equation.forward_euler_step(real(0), u)));
  return search_step(data.size(), unit, how, [&](std::size_t k, double dt) {
    state after = data[k];
    const target<state, real> to{&after, real(1), real(dt), true};
    equation.add_transport(real(0), data[k], std::span(&to, 1));
    return property.excess(data[k], after);
  });
}

}  // namespace apsis
