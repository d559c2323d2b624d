#pragma once

#include <sundials/sundials_linearsolver.h>

namespace apsis::bench::peers {

/// Returns a linear solver for SUNDIALS that uses the preconditioner as the inverse, without Krylov
/// iterations and Jacobian products. The result is a modified Newton method with an approximate Jacobian.
SUNLinearSolver make_preconditioner_solver(SUNContext context);

}  // namespace apsis::bench::peers
