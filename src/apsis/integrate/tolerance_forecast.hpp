#pragma once

#include <apsis/integrate/error_control.hpp>
#include <apsis/method/plateau.hpp>

#include <algorithm>
#include <limits>

namespace apsis {

/// Forecast for a run to a tolerance, from data that are first brought to equilibrium.
template <class Real>
struct tolerance_forecast {
  Real dt;     ///< step length that the tolerance allows
  Real error;  ///< error of the O(ε) terms at the end, in the unit of the tolerance; 0 if nothing relaxes or
               ///< dt resolves every ε/C
};

namespace forecast {

/// Returns the step length at which a new controller settles at u: steps neither grow nor are rejected. At
/// most `longest`.
template <problem P, class Distance>
typename P::real settled_step(stepper<P>& method_stepper, typename P::real t, typename P::state& u,
                              typename P::real longest, const error_target<typename P::real>& target,
                              const Distance& distance) {
  using real = typename P::real;
  P& p = method_stepper.problem();
  error_estimate<P> estimate(method_stepper.weight_of_estimate(), method_stepper.resolves_collisions());
  step_controller<real> control(target.tolerance, target.order);
  start_control(p, t, u, longest, step_rule<real>::unlimited(), control, distance);
  real dt(0);
  for (int k = 0; k < 30; ++k) {  // factors of 5 cover 1e-20 to 1
    dt = std::min(longest, control.proposed());
    const bool rejected_before = control.rejected() > 0;
    real error(0);
    try {
      error = estimate(p, t, dt, u, method_stepper.attempt(t, dt, u), distance);
    } catch (const numerical_error&) {
      error = std::numeric_limits<real>::infinity();  // a step that fails is too long
    }
    const bool good = control.accepts(dt, error);
    if (good && (rejected_before || dt >= longest || control.proposed() <= dt * real(1.3))) break;
  }
  return dt;
}

/// Size of the O(ε) terms: D (z/(1+z))³ and D z³/(1+z)⁴, where D is the deviation from equilibrium that
/// transport sustains and z = CΔt/ε in each cell.
template <class Real>
struct deviations {
  Real plateau,  ///< D (z/(1+z))³, relative to u
      band;      ///< D z³/(1+z)⁴, relative to u
  Real change;   ///< relative change of u in the step
};

/// Computes the deviations by a step dt of implicit–explicit Euler from the equilibrium `u`, with repeated
/// solves. u + dt T(u) deviates from equilibrium by zD, and each solve divides this by 1 + z.
template <problem P, class Distance>
deviations<typename P::real> compute_deviations(P& p, typename P::real t, const typename P::state& u,
                                                typename P::real dt, const Distance& distance) {
  using real = typename P::real;
  using state = typename P::state;
  state now = u, plateau = u, band = u, zero = u;
  const target<state, real> moved{&now, real(1), dt, true};
  p.add_transport(t, u, {&moved, 1});
  combine(p, {{real(0), &u}}, zero);
  const real of_plateau[] = {1, -2, 1, 0}, of_band[] = {0, 1, -2, 1};
  for (int k = 0; k < 4; ++k) {
    p.solve_collision(t + dt, dt, real(0), now);
    if (k == 0) {
      combine(p, {{of_plateau[k], &now}}, plateau);
      combine(p, {{of_band[k], &now}}, band);
    } else {
      combine(p, {{real(1), &plateau}, {of_plateau[k], &now}}, plateau);
      combine(p, {{real(1), &band}, {of_band[k], &now}}, band);
    }
  }
  // Form distance(u, u − x) for norms that are relative to their first argument.
  const real size = distance(u, zero);
  const real change = distance(now, u) / distance(now, zero);
  combine(p, {{real(1), &plateau}, {real(1), &u}}, plateau);
  combine(p, {{real(1), &band}, {real(1), &u}}, band);
  return {distance(u, plateau), distance(u, band), size > real(0) ? change : real(0)};
}

}  // namespace forecast

/// Forecasts a run of length `interval` from u at time t with steps of at most `longest`; `bounds` are those
/// of the method. The error has two parts, both fractions of the deviation from equilibrium by
/// plateau_bounds: one in u, and one in the moments. The latter accumulates over the time in which the
/// moments change by their own size, or over the interval if that is shorter. If a step fails, returns the
/// values computed so far.
template <problem P, class Distance>
tolerance_forecast<typename P::real> forecast_tolerance(stepper<P>& method_stepper, typename P::real t,
                                                        const typename P::state& u, typename P::real interval,
                                                        typename P::real longest,
                                                        const error_target<typename P::real>& target,
                                                        const plateau_bounds& bounds,
                                                        const Distance& distance) {
  using real = typename P::real;
  P& p = method_stepper.problem();
  auto from = u;
  tolerance_forecast<real> found{longest, real(0)};
  real relaxation = std::numeric_limits<real>::infinity();
  if constexpr (problem_with_relaxation_time<P>) relaxation = p.relaxation_time(t, u);
  const bool relaxes = relaxation < std::numeric_limits<real>::infinity();
  try {
    if (relaxes) project_to_equilibrium(p, t, from);
    const auto equilibrium = from;
    if (relaxes) {  // a tiny step moves it to the slow manifold
      const auto& tried = method_stepper.attempt(t, longest * real(1e-5), from);
      from = tried.result;
    }
    found.dt = forecast::settled_step(method_stepper, t, from, longest, target, distance);
    // Steps far below the relaxation time resolve the O(ε) terms to their order.
    if (!relaxes || found.dt < relaxation / 32) return found;
    const auto [plateau, band, change] = forecast::compute_deviations(p, t, equilibrium, found.dt, distance);
    const real moved = std::min(real(1), change * std::max(real(1), interval / found.dt));
    found.error = (real(bounds.last) + moved * real(bounds.flux)) * plateau +
                  (real(bounds.last_band) + moved * real(bounds.flux_band)) * band;
  } catch (const numerical_error&) {
    return found;  // the run itself will report invalid data
  }
  return found;
}

}  // namespace apsis
