#pragma once

#include <apsis/integrate/problem.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/tableau.hpp>

#include <cstddef>
#include <limits>
#include <span>

namespace apsis {

/// A problem that solves its collision exactly, for exponential methods:
///   advance_collision(t, s, u)   in place: u ← v(s), the solution of v' = Q(v) from v(0) = u, s ≥ 0
template <class P>
concept problem_with_exact_collision =
    problem<P> && requires(P p, typename P::state& u, typename P::real x) { p.advance_collision(x, x, u); };

/// A problem whose stage solves are replaced by exact solutions of its collision: solve_collision(t, a, 0, u)
/// is u ← exp(aQ) u. A method of the paper's class without Q̇ then is an exponential method, with the same
/// stepper; its order conditions are those of exponential_method(). Stores a reference to the problem.
template <problem_with_exact_collision P>
class exact_collisions {
 public:
  using state = typename P::state;  ///< type of u
  using real = typename P::real;    ///< type of time and coefficients

  /// `p` must outlive this object.
  explicit exact_collisions(P& p) : problem_(p) {}

  /// Required by `problem`.
  void add_transport(real t, const state& u, std::span<const target<state, real>> targets) {
    problem_.add_transport(t, u, targets);
  }
  /// Sets u ← exp(aQ) u; b must be 0.
  void solve_collision(real t, real a, real, state& u) { problem_.advance_collision(t, a, u); }
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

/// Returns an exponential method of second order of the class of Hu and Shu (J. Sci. Comput. /
/// arXiv:1807.03728), convex combinations of forward Euler steps of T and exact collisions:
///   f₀ = exp(a₀ΔtQ) u^n,   f₁ = exp(a₁ΔtQ)(f₀ + b₁Δt T(f₀)),
///   u^{n+1} = exp(a₂ΔtQ)(w (f₁ + b₂Δt T(f₁)) + (1 − w) exp(a₁ΔtQ) f₀).
/// Second order requires w(b₁ + b₂) = 1, w b₁b₂ = 1/2, a₀ + a₁ + a₂ = 1 and a₀ + w b₂a₁ = 1/2. The largest
/// step that preserves what forward Euler steps preserve, Δt ≤ Δt_FE (r = 1), has b₁ = b₂ = 1, w = 1/2; then
/// a₁ = 1 − 2a₀ and a₂ = a₀, and a = 1/3 for all three here. For ε → 0 every f is the equilibrium of its
/// moments, which take a step of SSP-RK2; u^{n+1} is in equilibrium as well. For exact_collisions only.
template <class Real>
shu_osher_form<Real> exponential_method() {
  constexpr std::size_t rows = 4;
  shu_osher_form<Real> m{matrix<Real>(rows, rows), matrix<Real>(rows, rows), matrix<Real>(rows, rows),
                         std::vector<Real>(rows), Real(1)};
  const Real third = Real(1) / Real(3), half = Real(1) / Real(2);
  m.D(0, 0) = third;  // f₀
  m.W(1, 0) = Real(1);
  m.D(1, 1) = third;  // f₁
  m.P(2, 0) = Real(1);
  m.D(2, 2) = third;  // exp(a₁ΔtQ) f₀
  m.W(3, 1) = half;
  m.P(3, 2) = half;
  m.D(3, 3) = third;
  return m;
}

}  // namespace apsis
