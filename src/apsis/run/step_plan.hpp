#pragma once

#include <apsis/integrate/integrate.hpp>
#include <apsis/integrate/tolerance_forecast.hpp>
#include <apsis/run/setup.hpp>

namespace apsis {

/// Returns the marcher from 0 to time.end with stops at multiples of output.every. A time.dt that does
/// not divide time.end is reduced. One that does not divide output.every becomes the longest step.
/// Warns in both cases.
time_marcher<double> times_of(const run_setup& setup);

/// Warns about an explicit method with a stiff collision. The method needs more than 10⁸ steps of about ε/C =
/// `relaxation`, or is unstable in given steps. `dt` is the first step.
void warn_of_stiff_collision(const run_setup& setup, double relaxation, double dt);

/// Warns if the explicit source of a law changes the variables faster than steps dt resolve. `growth` is
/// source_rate::growth.
void warn_of_fast_source(double growth, double dt);

/// Warns if steps dt move the steady state to which a run with time.steady marches. The steady state of a
/// method with steady_state_defect() depends on dt/epsilon, at most dt over `relaxation`.
void warn_of_moved_steady_state(const run_setup& setup, double relaxation, double dt);

/// Warns about implicit stages whose dense Newton systems have more than 200 unknowns.
void warn_of_dense_stages(const run_setup& setup);

/// Warns if a first step dt skips the initial layer of the data u, whose width is `relaxation`, and
/// the remaining error exceeds time.tolerance. Methods of types ARS and CK begin with T(u) of data
/// off equilibrium. Their relative error is Δt ‖T(u) − T(E(ℛu))‖/‖u‖, and error estimates do not
/// detect it. Collective.
void warn_of_layer(const run_setup& setup, semidiscrete_problem& problem, const field& u, double relaxation,
                   double dt);

/// Warns if the forecast error exceeds time.tolerance, and suggests remedies.
void warn_of_plateau(const run_setup& setup, const tolerance_forecast<double>& expected, double relaxation);

}  // namespace apsis
