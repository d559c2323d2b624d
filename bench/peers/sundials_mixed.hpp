#pragma once

#include "mixed.hpp"

namespace apsis::bench::peers {

/// How SUNDIALS solves the linear systems of Newton's method.
enum class linear_solver {
  spgmr,            ///< its default for large systems, without preconditioner
  preconditioned,   ///< with `projection`
  projection_only,  ///< that alone, as if it were the inverse
};

struct sundials_options {
  enum class integrator { arkode, cvode } which = integrator::arkode;
  int order = 4;  ///< of the tables of ARKODE
  linear_solver linear = linear_solver::spgmr;
  bool tuned = false;      ///< ARKODE: implicit right-hand side deduced; both: up to 20 nonlinear iterations
  double nonlinear = 0.0;  ///< coefficient of the nonlinear convergence test; 0: as it comes
  bool constrained = false;  ///< f ≥ 0 asked for
  double rtol = 1e-4, atol = 1e-8;
  double longest = 0.0;  ///< step; 0: no limit
  double seconds_allowed = 60.0;
};

/// ARKODE: T explicit, Q/ε implicit, adaptive. CVODE: BDF, both implicit.
outcome run_sundials(mixed_regime& what, const sundials_options& how, field* result = nullptr);

}  // namespace apsis::bench::peers
