#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/verbs.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace apsis {

/// Returns w_n = Π_{m≠n} n/(n − m), m = 1, …, columns. If the error of the result of n substeps has an
/// expansion in powers of 1/n, the error of Σ_n w_n u_n has the order of the number of columns.
template <class Real>
Real extrapolation_weight(int n, int columns) {
  Real product(1);
  for (int m = 1; m <= columns; ++m)
    if (m != n) product *= Real(n) / Real(n - m);
  return product;
}

/// Options of extrapolate().
template <class Real>
struct extrapolation_options {
  Real tolerance;             ///< bound of the estimated error of a step, in the given distance
  Real first_step = Real(0);  ///< initial step; 0 stands for 1e-12 of the interval
  int order = 8;              ///< number K of columns and order of the result; the estimate has order K − 1
  long most_steps = 100000;   ///< limit on accepted and rejected steps, exceeded if the tolerance
                              ///< is below rounding
};

/// Computes a reference solution of u' = T(t, u) + Q(u) by extrapolation of implicit–explicit Euler steps v =
/// u + h T(u) + h Q(v). It shares no coefficients with any method of the catalogue. A step of length H is
/// taken with n = 1, 2, …, K substeps. Their combination Σ_n w_n u_n with w_n = Π_{m≠n} n/(n − m) has order
/// K, because the error of Euler's method has an expansion in powers of 1/n. The difference to the result
/// without the last column controls the step length, so that steps resolve an initial layer. Outside the
/// layer accuracy alone limits the step, whatever ε is. `distance(u, v)` is a norm of u − v. Returns the
/// number of accepted steps; u is then the solution at t1. Rounding errors are amplified by Σ|w_n| ≈ 4e3 for
/// K = 8. Throws numerical_error if steps become too small or too many. (Deuflhard 1983; for IMEX:
/// Constantinescu & Sandu, SIAM J. Sci. Comput. 31 (2010) 4452.)
template <problem P, class Distance>
long extrapolate(P& p, typename P::state& u, typename P::real t0, typename P::real t1,
                 extrapolation_options<typename P::real> options, const Distance& distance) {
  using real = typename P::real;
  using state = typename P::state;
  const auto add = [&](real alpha, const state& from, state& sum, bool fresh) {
    if (fresh)
      combine(p, {{alpha, &from}}, sum);
    else
      combine(p, {{real(1), &sum}, {alpha, &from}}, sum);
  };

  // Combine the increments v − u, not the values: they are small, and so are their rounding errors.
  state result = u, lower = u, v = u, next = u;
  const auto attempt = [&](real t, real H) {
    for (int n = 1; n <= options.order; ++n) {
      const real h = H / real(n);
      v = u;
      for (int k = 0; k < n; ++k) {
        const real now = t + real(k) * h;
        const target<state, real> moved{&next, real(1), h, true};
        p.add_transport(now, v, {&moved, 1});
        p.solve_collision(now + h, h, real(0), next);
        std::swap(v, next);
      }
      combine(p, {{real(1), &v}, {real(-1), &u}}, v);
      add(extrapolation_weight<real>(n, options.order), v, result, n == 1);
      if (n < options.order) add(extrapolation_weight<real>(n, options.order - 1), v, lower, n == 1);
    }
    add(real(1), u, result, false);
    add(real(1), u, lower, false);
    return distance(result, lower);
  };

  long steps = 0, attempts = 0;
  real t = t0, H = options.first_step > real(0) ? options.first_step : (t1 - t0) * real(1e-12);
  while (t < t1) {
    const bool last = t1 - t <= H;
    const real step = last ? t1 - t : H;
    if (++attempts > options.most_steps || !(t + step > t))
      throw numerical_error(
          "the reference solution needs too many steps (its tolerance is too small); enlarge it",
          {steps, static_cast<double>(t), -1, static_cast<double>(step)});
    using std::pow;
    // An inadmissible intermediate state or a NaN counts as a step that is too long.
    constexpr real too_long = std::numeric_limits<real>::infinity();
    real error = too_long;
    try {
      error = attempt(t, step);
      if (!(error <= too_long)) error = too_long;
    } catch (const numerical_error&) {
      error = too_long;
    }
    if (error <= options.tolerance) {
      t = last ? t1 : t + step;
      std::swap(u, result);
      ++steps;
    }
    const real floor = options.tolerance * real(1e-8);
    const real factor =
        real(0.9) * pow(options.tolerance / std::max(error, floor), real(1) / real(options.order));
    H = step * std::clamp(factor, real(0.2), real(4));
  }
  return steps;
}

}  // namespace apsis
