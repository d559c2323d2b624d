#include "preconditioner_solver.hpp"

namespace apsis::bench::peers {
namespace {

struct preconditioner {
  void* data = nullptr;
  SUNPSetupFn setup = nullptr;
  SUNPSolveFn solve = nullptr;
};

preconditioner& of(SUNLinearSolver solver) {
  return *static_cast<preconditioner*>(solver->content);
}

}  // namespace

SUNLinearSolver make_preconditioner_solver(SUNContext context) {
  SUNLinearSolver made = SUNLinSolNewEmpty(context);
  made->content = new preconditioner;
  made->ops->gettype = [](SUNLinearSolver) { return SUNLINEARSOLVER_ITERATIVE; };
  made->ops->setatimes = [](SUNLinearSolver, void*, SUNATimesFn) { return 0; };
  made->ops->setpreconditioner = [](SUNLinearSolver s, void* data, SUNPSetupFn setup, SUNPSolveFn solve) {
    of(s) = {data, setup, solve};
    return 0;
  };
  made->ops->initialize = [](SUNLinearSolver) { return 0; };
  made->ops->setup = [](SUNLinearSolver s, SUNMatrix) {
    return of(s).setup != nullptr ? of(s).setup(of(s).data) : 0;
  };
  made->ops->solve = [](SUNLinearSolver s, SUNMatrix, N_Vector x, N_Vector b, realtype tolerance) {
    return of(s).solve(of(s).data, b, x, tolerance, SUN_PREC_LEFT);
  };
  made->ops->free = [](SUNLinearSolver s) {
    delete &of(s);
    s->content = nullptr;
    SUNLinSolFreeEmpty(s);
    return 0;
  };
  return made;
}

}  // namespace apsis::bench::peers
