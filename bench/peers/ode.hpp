#pragma once

#include "contest.hpp"

#include <apsis/method/method.hpp>

#include <paper/ode_study.hpp>

namespace apsis::bench::peers {

/// The ODE model of the paper from t = 0 to 1 (paper/ode_study.hpp): two unknowns, u2 initially
/// out of equilibrium.
struct ode_task {
  double epsilon;
  ode_state<long double> exact;
};

/// Runs `steps` equal steps; `graded`: the first of them divided into steps that resolve the initial layer.
/// Seconds are those of one of many integrations, without the construction of the stepper; errors are |Δu1| +
/// |Δu2| at t = 1.
outcome run_ode(const ode_task& task, const method& m, long steps, bool graded);

struct sundials_ode_options {
  enum class integrator {
    cvode,        ///< BDF
    arkode_imex,  ///< (u2, 0) explicit, the rest implicit
    arkode_dirk,  ///< all implicit
  } which = integrator::cvode;
  int order = 5;             ///< order of ARKODE
  bool tuned = false;        ///< exact Jacobian; ARKODE also deduces the implicit right-hand side
  bool constrained = false;  ///< CVODE: constrains both unknowns to be ≥ 0, as they are
  double nonlinear = 0.0;    ///< coefficient of the nonlinear convergence test; 0: default
  double rtol = 1e-6, atol = 1e-8;
};

/// Runs SUNDIALS with a dense linear solver; memory is allocated once and the integrator reinitialized.
outcome run_sundials_ode(const ode_task& task, const sundials_ode_options& options);

}  // namespace apsis::bench::peers
