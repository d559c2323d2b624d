#pragma once

#include <apsis/method/tableau.hpp>

#include <cstddef>
#include <vector>

namespace apsis {

// A method with exact collisions, of the class of Hu and Shu (arXiv:1807.03728), has the Shu–Osher form of an
// IMEX method without Q̇. The exact solution of the collision replaces every stage solve:
//   u_i = exp(d_i Δt Q)(r_i u^n + Σ_{j<i} p_ij u_j + Σ_{j<i} w_ij (u_j + (Δt/r) T(u_j))),    u^{n+1} = u_s,
// where exp(sQ) u is the solution v(s) of v' = Q(v), v(0) = u. If all weights and d_i are ≥ 0, it preserves
// for Δt ≤ r Δt_FE every convex property that forward Euler steps of T and exact collisions preserve.
// Dimensionless.

/// Largest order whose conditions follow from with_resolved_flows(). Methods with d_i ≥ 0 have at most order
/// 2 (Goldman, Kaper, SIAM J. Numer. Anal. 33 (1996) 349–367, for compositions).
inline constexpr int order_of_resolved_flows = 4;

/// Returns an additive Runge–Kutta method in which every exact collision is a step of the classical method of
/// fourth order for v' = Q(v). Its order conditions up to order 4 are those of the method with exact
/// collisions.
template <class Real>
shu_osher_form<Real> with_resolved_flows(const shu_osher_form<Real>& m) {
  constexpr std::size_t rows_of_flow = 4;
  const std::size_t s = m.stages();
  std::vector<std::size_t> place;  // row of u_i
  std::size_t rows = 0;
  for (std::size_t i = 0; i < s; ++i) {
    rows += m.D(i, i) == Real(0) ? 1 : 1 + rows_of_flow;
    place.push_back(rows - 1);
  }
  shu_osher_form<Real> all{matrix<Real>(rows, rows), matrix<Real>(rows, rows), matrix<Real>(rows, rows),
                           std::vector<Real>(rows, Real(0)), m.r};
  for (std::size_t i = 0; i < s; ++i) {
    const Real d = m.D(i, i);
    const std::size_t start = d == Real(0) ? place[i] : place[i] - rows_of_flow;
    for (std::size_t j = 0; j < i; ++j) {
      all.P(start, place[j]) = m.P(i, j);
      all.W(start, place[j]) = m.W(i, j);
    }
    if (d == Real(0)) continue;
    for (std::size_t k = 1; k <= rows_of_flow; ++k) all.P(start + k, start) = Real(1);
    all.D(start + 1, start) = d / Real(2);
    all.D(start + 2, start + 1) = d / Real(2);
    all.D(start + 3, start + 2) = d;
    for (std::size_t k = 0; k < rows_of_flow; ++k)
      all.D(start + 4, start + k) = d / Real(k == 0 || k == 3 ? 6 : 3);
  }
  return all;
}

/// Returns the largest r for which the rows of a convex form are convex combinations of u^n, stages and
/// forward Euler steps of length Δt/r. It is the least r_m (p_ij + w_ij)/w_ij over w_ij > 0, where r_m is the
/// r of the form. Returns 0 for a form without transport, which sets no limit.
template <class Real>
Real largest_step_of_form(const shu_osher_form<Real>& m) {
  Real least(0);
  for (std::size_t i = 0; i < m.stages(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (m.W(i, j) > Real(0)) {
        const Real r = m.r * ((m.P(i, j) + m.W(i, j)) / m.W(i, j));
        if (least == Real(0) || r < least) least = r;
      }
  return least;
}

}  // namespace apsis
