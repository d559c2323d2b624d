#pragma once

#include <apsis/integrate/array_state.hpp>
#include <apsis/integrate/problem.hpp>

#include <concepts>
#include <initializer_list>
#include <span>

namespace apsis {

/// Operations on states that error estimates need and a time step does not. A problem may define them. This
/// file has their defaults.

/// A problem whose states are arrays of its number type.
template <class P>
concept array_of_reals = problem<P> && array_state<typename P::state> &&
                         std::same_as<typename P::real, state_real<typename P::state>>;

/// sum ← Σ_k α_k u_k for at least one term, added in their order. `sum` may be the state of the first term,
/// and of no other; it must have the size of the states. If the problem has no combine(), an array_state is
/// combined by arithmetic. Other states are combined by add_transport() with β = 0, which does not evaluate
/// T.
template <problem P>
void combine(P& p, std::initializer_list<linear_term<typename P::state, typename P::real>> terms,
             typename P::state& sum) {
  using state = typename P::state;
  using real = typename P::real;
  if constexpr (problem_with_combination<P>) {
    p.combine(std::span<const linear_term<state, real>>(terms.begin(), terms.size()), sum);
  } else {
    bool fresh = true;
    for (const auto& [alpha, u] : terms) {
      const target<state, real> to{&sum, alpha, real(0), fresh};
      const std::span<const target<state, real>> targets(&to, 1);
      const bool there = fresh && u == &sum && alpha == real(1);
      fresh = false;
      if (there) continue;
      if constexpr (array_of_reals<P>) {
        accumulate<state>(targets, *u, [at = u]() -> const state& { return *at; });  // not called
      } else {
        p.add_transport(real(0), *u, targets);
      }
    }
  }
}

/// Returns the length a of a stage that projects: a C/ε ≫ 1 leaves less of u than rounding errors.
template <class Real>
Real time_to_equilibrium() {
  return Real(1e100);
}

/// u ← E(ℛu), the equilibrium with the moments of u, to which collisions lead after a long time. u does not
/// change where nothing relaxes. If the problem has no project_to_equilibrium(), a stage v = u + a Q(v) with
/// a = time_to_equilibrium gives the equilibrium up to rounding. Throws what the stage solve of the problem
/// throws.
template <problem P>
void project_to_equilibrium(P& p, typename P::real t, typename P::state& u) {
  using real = typename P::real;
  if constexpr (problem_with_projection<P>) {
    p.project_to_equilibrium(t, u);
  } else {
    p.solve_collision(t, time_to_equilibrium<real>(), real(0), u);
  }
}

}  // namespace apsis
