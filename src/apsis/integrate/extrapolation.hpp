#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/problem.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace apsis {

/// How accurately extrapolate() works.
template <class Real>
struct extrapolation_options {
  Real tolerance;             ///< largest estimated error of one step, in the distance that is used
  Real first_step = Real(0);  ///< a first guess, 0: 1e-12 of the interval
  int order = 8;              ///< number of columns; order of the result, the estimate has one less
  long most_steps = 100000;   ///< accepted and rejected; more means that the tolerance is below rounding
};

/// A reference solution of u' = T(t, u) + Q(u) that shares no coefficients with any method of the catalogue:
/// implicit–explicit Euler steps v = u + h T(u) + h Q(v), extrapolated. A step of length H is made with
/// n = 1, 2, …, K substeps, and Σ_n w_n u_n with w_n = Π_{m≠n} n/(n − m) has order K, because the error of
/// Euler's method is a polynomial in 1/n. Step lengths follow from the difference to the value without the
/// last of them, so that an initial layer is resolved; beyond it steps are as long as accuracy allows,
/// whatever ε is. `distance(u, v)` says how far two states are apart. Returns the number of accepted steps; u
/// is the solution at t1. Rounding is amplified by Σ|w_n| ≈ 4e3 for K = 8. Throws numerical_error if steps
/// become too small. (Deuflhard 1983; for IMEX: Constantinescu & Sandu, SIAM J. Sci. Comput. 31 (2010) 4452.)
template <problem P, class Distance>
long extrapolate(P& p, typename P::state& u, typename P::real t0, typename P::real t1,
                 extrapolation_options<typename P::real> how, const Distance& distance) {
  using real = typename P::real;
  using state = typename P::state;
  using goal = target<state, real>;
  const auto weights = [](int first, int last) {
    std::vector<real> w;
    for (int n = first; n <= last; ++n) {
      real product(1);
      for (int m = first; m <= last; ++m)
        if (m != n) product *= real(n) / real(n - m);
      w.push_back(product);
    }
    return w;
  };
  const auto high = weights(1, how.order), low = weights(1, how.order - 1);
  const auto add = [&](real t, const state& from, std::initializer_list<goal> to) {
    const std::vector<goal> targets(to);
    p.add_transport(t, from, std::span<const goal>(targets));
  };

  // The increments v − u are combined, not the values: they are small, and so is what rounding makes of them.
  state result = u, lower = u, v = u, next = u;
  const auto attempt = [&](real t, real H) {
    for (int n = 1; n <= how.order; ++n) {
      const real h = H / real(n);
      v = u;
      for (int k = 0; k < n; ++k) {
        const real now = t + real(k) * h;
        add(now, v, {{&next, real(1), h, true}});
        p.solve_collision(now + h, h, real(0), next);
        std::swap(v, next);
      }
      add(t, u, {{&v, real(-1), real(0), false}});
      const std::size_t i = static_cast<std::size_t>(n) - 1;
      if (n < how.order)
        add(t, v, {{&result, high[i], real(0), n == 1}, {&lower, low[i], real(0), n == 1}});
      else
        add(t, v, {{&result, high[i], real(0), false}});
    }
    add(t, u, {{&result, real(1), real(0), false}, {&lower, real(1), real(0), false}});
    return distance(result, lower);
  };

  long steps = 0, attempts = 0;
  real t = t0, H = how.first_step > real(0) ? how.first_step : (t1 - t0) * real(1e-12);
  while (t < t1) {
    const bool last = t1 - t <= H;
    const real step = last ? t1 - t : H;
    if (++attempts > how.most_steps || !(t + step > t))
      throw numerical_error(
          "the reference solution needs too many steps (its tolerance is too small); enlarge it",
          {steps, static_cast<double>(t), -1, static_cast<double>(step)});
    using std::pow;
    // An inadmissible state on the way, or no number: as a step that is too long.
    constexpr real too_long = std::numeric_limits<real>::infinity();
    real error = too_long;
    try {
      error = attempt(t, step);
      if (!(error <= too_long)) error = too_long;
    } catch (const numerical_error&) {
      error = too_long;
    }
    if (error <= how.tolerance) {
      t = last ? t1 : t + step;
      std::swap(u, result);
      ++steps;
    }
    const real floor = how.tolerance * real(1e-8);
    const real factor = real(0.9) * pow(how.tolerance / std::max(error, floor), real(1) / real(how.order));
    H = step * std::clamp(factor, real(0.2), real(4));
  }
  return steps;
}

}  // namespace apsis
