#pragma once

#include "peers/stiff_task.hpp"

namespace apsis::bench::peers {

struct sundials_ode_options {
  enum class integrator {
    cvode,            ///< BDF
    arkode_imex,      ///< T explicit, Q/ε implicit
    arkode_dirk,      ///< all implicit
    arkode_explicit,  ///< all explicit
  } which = integrator::cvode;
  int order = 5;             ///< order of ARKODE
  bool tuned = false;        ///< exact Jacobian; ARKODE also deduces the implicit right-hand side
  bool constrained = false;  ///< CVODE: constrains both unknowns to be ≥ 0
  double nonlinear = 0.0;    ///< coefficient of the nonlinear convergence test; 0: default
  double rtol = 1e-6, atol = 1e-8;
};

/// Runs SUNDIALS with a dense linear solver; memory is allocated once and the integrator reinitialized.
outcome run_sundials_ode(const stiff_task& task, const sundials_ode_options& options);

}  // namespace apsis::bench::peers
