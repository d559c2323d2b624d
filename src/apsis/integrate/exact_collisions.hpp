#pragma once

#include <apsis/integrate/problem.hpp>

#include <span>

namespace apsis {

/// A problem whose collision has a known solution:
///   advance_collision(t, s, u)   in place: u ← exp(sQ) u, s ≥ 0
template <class P>
concept problem_with_known_collision =
    problem<P> && requires(P p, typename P::state& u, typename P::real x) { p.advance_collision(x, x, u); };

/// A problem for methods with exact collisions (method/resolved_flows.hpp). Its stage solves are exact
/// solutions of the collision of another problem.
template <problem_with_known_collision P>
class exact_collisions {
 public:
  using state = typename P::state;  ///< type of u
  using real = typename P::real;    ///< type of time and coefficients

  /// `p` must outlive this object.
  explicit exact_collisions(P& p) : problem_(p) {}

  /// Required by `problem_with_exact_collision`.
  bool collides_exactly() const { return true; }
  /// Required by `problem`.
  void add_transport(real t, const state& u, std::span<const target<state, real>> targets) {
    problem_.add_transport(t, u, targets);
  }
  /// Sets u ← exp(aQ) u; b must be 0.
  void solve_collision(real t, real a, real, state& u) { problem_.advance_collision(t, a, u); }
  /// Required by `problem_with_combination`.
  void combine(std::span<const linear_term<state, real>> terms, state& sum)
    requires problem_with_combination<P>
  {
    problem_.combine(terms, sum);
  }
  /// Required by `problem_with_projection`.
  void project_to_equilibrium(real t, state& u)
    requires problem_with_projection<P>
  {
    problem_.project_to_equilibrium(t, u);
  }
  /// Required by `problem`.
  real forward_euler_step(real t, const state& u) const { return problem_.forward_euler_step(t, u); }
  /// Required by `problem_with_relaxation_time`.
  real relaxation_time(real t, const state& u) const
    requires problem_with_relaxation_time<P>
  {
    return problem_.relaxation_time(t, u);
  }

 private:
  P& problem_;
};

}  // namespace apsis
