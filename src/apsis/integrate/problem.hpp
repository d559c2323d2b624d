#pragma once

#include <concepts>
#include <span>

namespace apsis {

/// One accumulator of add_transport: acc ← (fresh ? 0 : acc) + α u + β T(t, u). `acc` may alias u only if no
/// target of the same call has β ≠ 0.
template <class State, class Real>
struct target {
  State* acc;  ///< the accumulator
  Real alpha;  ///< coefficient of u
  Real beta;   ///< coefficient of T(t, u), a multiple of Δt
  bool fresh;  ///< acc is overwritten: its old content is undefined (possibly NaN)

  /// Returns the new value of an element of acc, given its old value and the same element of u and T(u).
  template <class V>
  V combine(const V& old, const V& u, const V& transport) const {
    return fresh ? V(alpha * u + beta * transport) : V(old + (alpha * u + beta * transport));
  }
};

/// A term α u of a linear combination of states.
template <class State, class Real>
struct linear_term {
  Real alpha;      ///< coefficient
  const State* u;  ///< a state
};

/// Interface of a problem u' = T(t, u) + Q(u) to the integrator. Two functions suffice for a time step; they
/// hide ε, the mesh and the model. `state` must be copyable and swappable; it needs no arithmetic. Estimates
/// of errors also form linear combinations of states and project to equilibrium, by the functions combine()
/// and project_to_equilibrium() of verbs.hpp, which have defaults.
///
///   add_transport(t, u, targets)   for each target: acc ← (fresh ? 0 : acc) + α u + β T(t, u); T is
///                                  evaluated once, and not at all if every β is 0
///   solve_collision(t, a, b, u)    in place: u ← v with v = u + a Q(v) + b Q̇(v), a ≥ 0, b ≤ 0
///   forward_euler_step(t, u)       forward Euler step Δt_FE of T for the property to be preserved;
///                                  +infinity if T sets no limit
template <class P>
concept problem = requires(P p, const typename P::state& u, typename P::state& v, typename P::real x,
                           std::span<const target<typename P::state, typename P::real>> targets) {
  requires std::copyable<typename P::state>;
  requires std::swappable<typename P::state>;
  p.add_transport(x, u, targets);
  p.solve_collision(x, x, x, v);
  { p.forward_euler_step(x, u) } -> std::convertible_to<typename P::real>;
};

/// A problem with linear combinations of its own, faster than the default of verbs.hpp:
///   combine(terms, sum)   sum ← Σ_k α_k u_k, one term at least, added in their order; `sum` may be the state
///                         of the first term, and of no other
template <class P>
concept problem_with_combination =
    problem<P> && requires(P p, typename P::state& sum,
                           std::span<const linear_term<typename P::state, typename P::real>> terms) {
      p.combine(terms, sum);
    };

/// A problem with a projection of its own, faster or more accurate than the default of verbs.hpp:
///   project_to_equilibrium(t, u)   in place: u ← E(ℛu), the equilibrium with the moments of u, where
///                                  collisions lead after a long time; u where nothing relaxes
template <class P>
concept problem_with_projection =
    problem<P> && requires(P p, typename P::state& u, typename P::real x) { p.project_to_equilibrium(x, u); };

/// A problem that also evaluates Q, for methods in which Q enters a stage explicitly:
///   add_collision(t, u, targets)   for each target: acc ← (fresh ? 0 : acc) + α u + β Q(u)
template <class P>
concept problem_with_explicit_collision =
    problem<P> && requires(P p, const typename P::state& u, typename P::real x,
                           std::span<const target<typename P::state, typename P::real>> targets) {
      p.add_collision(x, u, targets);
    };

/// A problem that evaluates T and Q together, for explicit methods, which give both the same coefficients:
///   add_transport_and_collision(t, u, targets)   for each target:
///                                                acc ← (fresh ? 0 : acc) + α u + β (T(t, u) + Q(u))
/// For a small system the sums over stages take longer than T and Q.
template <class P>
concept problem_with_joint_evaluation =
    problem_with_explicit_collision<P> &&
    requires(P p, const typename P::state& u, typename P::real x,
             std::span<const target<typename P::state, typename P::real>> targets) {
      p.add_transport_and_collision(x, u, targets);
    };

/// A problem that reports whether it solves collisions exactly, as methods with exact collisions need:
///   collides_exactly()   whether solve_collision(t, s, 0, u) is u ← exp(sQ) u instead of an implicit stage:
///                        the solution after a time s of v' = Q(v), v(0) = u
template <class P>
concept problem_with_exact_collision = problem<P> && requires(const P p) {
  { p.collides_exactly() } -> std::convertible_to<bool>;
};

/// Whether a problem solves its collisions exactly.
template <problem P>
bool collides_exactly(const P& p) {
  if constexpr (problem_with_exact_collision<P>)
    return p.collides_exactly();
  else
    return false;
}

/// A problem whose Q depends on time, u' = T(t, u) + Q(t, u). Where time is integrated as part of T, Q̇ has no
/// ∂Q/∂t, and solve_collision(t, a, b, u) solves the stage. A method without T integrates time as part of Q:
///   solve_timed_collision(t, a, b, u)   in place: u ← v with v = u + a Q(t, v) + b (Q'(t, v)Q(t, v) +
///                                       ∂Q(t, v)/∂t), t the time of the stage
template <class P>
concept problem_with_timed_collision = problem<P> && requires(P p, typename P::state& v, typename P::real x) {
  p.solve_timed_collision(x, x, x, v);
};

/// A problem that reports whether it has transport, so that implicit-only methods are rejected:
///   has_transport(t, u)   whether T(t, u) ≠ 0
template <class P>
concept problem_with_transport_check =
    problem<P> && requires(P p, const typename P::state& u, typename P::real x) {
      { p.has_transport(x, u) } -> std::convertible_to<bool>;
    };

/// A problem whose states belong to an admissible set, such as that of positive states:
///   is_admissible(u)   whether u is admissible; a step to a tolerance is rejected if its result is not
template <class P>
concept problem_with_admissible_set = problem<P> && requires(P p, const typename P::state& u) {
  { p.is_admissible(u) } -> std::convertible_to<bool>;
};

/// A stage solve that is due as soon as add_transport has completed its target u: the
/// arguments of solve_collision.
template <class State, class Real>
struct due_collision {
  Real t,    ///< time of the stage
      a,     ///< Δt d ≥ 0
      b;     ///< Δt² ḋ ≤ 0
  State* u;  ///< explicit part of the stage, replaced by its solution
};

/// A problem that fuses add_transport and solve_collision into one pass over memory:
///   add_transport_and_solve(t, u, targets, due)   add_transport(t, u, targets), then
///       solve_collision(due.t, due.a, due.b, *due.u), with bitwise equal results
template <class P>
concept problem_with_fused_stages =
    problem<P> && requires(P p, const typename P::state& u, typename P::real x,
                           std::span<const target<typename P::state, typename P::real>> targets,
                           due_collision<typename P::state, typename P::real> due) {
      p.add_transport_and_solve(x, u, targets, due);
    };

/// A problem that may throw errors after the call in which they occur, so that a failing process does not
/// deadlock the others:
///   throw_late_errors()   rethrows the first error since its last call; a step calls it before it changes u
template <class P>
concept problem_with_late_errors = problem<P> && requires(P p) { p.throw_late_errors(); };

/// Throws the late errors of a problem that may have them.
template <problem P>
void throw_late_errors(P& p) {
  if constexpr (problem_with_late_errors<P>) p.throw_late_errors();
}

/// A problem that stores data shared by the stages of a step, such as a derivative:
///   begin_step(t, u)   a step of a method of one step begins with u at t; its stages follow
///   end_step()         the step has ended, or failed
template <class P>
concept problem_with_steps = problem<P> && requires(P p, const typename P::state& u, typename P::real x) {
  p.begin_step(x, u);
  p.end_step();
};

/// Notifies a problem_with_steps that a step begins and, at the end of the scope, that it has ended.
template <problem P>
class step_scope {
 public:
  /// Stores a reference.
  step_scope(P& p, typename P::real t, const typename P::state& u) : problem_(p) {
    if constexpr (problem_with_steps<P>) problem_.begin_step(t, u);
  }
  step_scope(const step_scope&) = delete;
  step_scope& operator=(const step_scope&) = delete;
  ~step_scope() {
    if constexpr (problem_with_steps<P>) problem_.end_step();
  }

 private:
  P& problem_;
};

/// A problem that provides the width of its initial layer, for a graded start:
///   relaxation_time(t, u)   smallest ε/C > 0 of the state; +infinity if nothing relaxes or ε = 0
template <class P>
concept problem_with_relaxation_time =
    problem<P> && requires(P p, const typename P::state& u, typename P::real x) {
      { p.relaxation_time(x, u) } -> std::convertible_to<typename P::real>;
    };

}  // namespace apsis
