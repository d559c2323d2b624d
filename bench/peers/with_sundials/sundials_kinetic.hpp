#pragma once

#include "peers/kinetic_task.hpp"

namespace apsis::bench::peers {

/// Linear solver of SUNDIALS in Newton's method.
enum class linear_solver {
  spgmr,           ///< default for large systems, without preconditioner
  preconditioned,  ///< preconditioned with the inverse of the linearized collision
  collision_only,  ///< this inverse alone
};

struct sundials_options {
  enum class integrator { arkode, cvode } which = integrator::arkode;
  int order = 4;  ///< order of the tables of ARKODE
  linear_solver linear = linear_solver::spgmr;
  bool tuned = false;      ///< ARKODE: implicit right-hand side deduced; both: up to 20 nonlinear iterations
  double nonlinear = 0.0;  ///< coefficient of the nonlinear convergence test; 0: default
  bool constrained = false;  ///< constrains f ≥ 0
  double rtol = 1e-4, atol = 1e-8;
  double longest = 0.0;  ///< longest step; 0: no limit
  double seconds_allowed = 60.0;
};

/// Runs ARKODE (adaptive, T explicit, Q/ε implicit) or CVODE (BDF, both implicit).
outcome run_sundials(kinetic_task& task, const sundials_options& options, field* result = nullptr);

}  // namespace apsis::bench::peers
