#include "field_vector.hpp"
#include "peers/collision_inverse.hpp"
#include "preconditioner_solver.hpp"
#include "sundials_kinetic.hpp"

#include <apsis/core/errors.hpp>

#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

#include <arkode/arkode_arkstep.h>
#include <cvode/cvode.h>
#include <sunlinsol/sunlinsol_spgmr.h>

namespace apsis::bench::peers {
namespace {

using goal = target<field, double>;

struct system_of_equations {
  semidiscrete_problem& problem;
  std::unique_ptr<collision_inverse> inverse;
};

system_of_equations& of(void* data) {
  return *static_cast<system_of_equations*>(data);
}

/// Runs body(). Returns 1, a recoverable error, for moments without an equilibrium, because a shorter step
/// may succeed.
template <class Body>
int recoverable(const Body& body) {
  try {
    body();
  } catch (const numerical_error&) {
    return 1;
  }
  return 0;
}

int transport_side(realtype t, N_Vector y, N_Vector out, void* data) {
  const std::array<goal, 1> to = {{{&field_of(out), 0.0, 1.0, true}}};
  return recoverable([&] { of(data).problem.add_transport(t, field_of(y), to); });
}

int collision_side(realtype t, N_Vector y, N_Vector out, void* data) {
  const std::array<goal, 1> to = {{{&field_of(out), 0.0, 1.0, true}}};
  return recoverable([&] { of(data).problem.add_collision(t, field_of(y), to); });
}

int both_sides(realtype t, N_Vector y, N_Vector out, void* data) {
  const std::array<goal, 1> add = {{{&field_of(out), 0.0, 1.0, false}}};
  if (transport_side(t, y, out, data) != 0) return 1;
  return recoverable([&] { of(data).problem.add_collision(t, field_of(y), add); });
}

int prepare_inverse(realtype, N_Vector y, N_Vector, booleantype still_good, booleantype* renewed, realtype,
                    void* data) {
  *renewed = still_good ? SUNFALSE : SUNTRUE;
  if (!still_good) of(data).inverse->prepare(field_of(y));
  return 0;
}

int apply_inverse(realtype, N_Vector, N_Vector, N_Vector r, N_Vector z, realtype gamma, realtype, int,
                  void* data) {
  of(data).inverse->solve(gamma, field_of(r), field_of(z));
  return 0;
}

void require(int flag, const char* what) {
  if (flag < 0) throw std::runtime_error(std::string(what) + " failed");
}

SUNLinearSolver make_linear_solver(linear_solver which, N_Vector like, SUNContext context) {
  if (which == linear_solver::collision_only) return make_preconditioner_solver(context);
  return SUNLinSol_SPGMR(like, which == linear_solver::spgmr ? SUN_PREC_NONE : SUN_PREC_LEFT, 0, context);
}

/// Resources of an integration.
struct workspace {
  owned_context sundials = make_context();
  owned_vector y, constraints;
  SUNLinearSolver linear = nullptr;
  void* memory = nullptr;
  bool is_arkode;

  workspace(const field& initial, const sundials_options& options)
      : y(make_field_vector(initial, sundials.get())),
        constraints(N_VClone(y.get())),
        linear(make_linear_solver(options.linear, y.get(), sundials.get())),
        is_arkode(options.which == sundials_options::integrator::arkode) {
    N_VConst(1.0, constraints.get());
  }
  workspace(const workspace&) = delete;
  workspace& operator=(const workspace&) = delete;
  ~workspace() {
    if (memory != nullptr) is_arkode ? ARKStepFree(&memory) : CVodeFree(&memory);
    SUNLinSolFree(linear);
  }
};

constexpr long many = 100000000;

void set_up_arkode(workspace& work, system_of_equations& equations, double end,
                   const sundials_options& options) {
  void* memory = work.memory =
      ARKStepCreate(transport_side, collision_side, 0.0, work.y.get(), work.sundials.get());
  require(ARKStepSetErrFile(memory, nullptr), "ARKStepSetErrFile");
  require(ARKStepSetUserData(memory, &equations), "ARKStepSetUserData");
  require(ARKStepSStolerances(memory, options.rtol, options.atol), "ARKStepSStolerances");
  require(ARKStepSetOrder(memory, options.order), "ARKStepSetOrder");
  require(ARKStepSetMaxNumSteps(memory, many), "ARKStepSetMaxNumSteps");
  require(ARKStepSetStopTime(memory, end), "ARKStepSetStopTime");
  require(ARKStepSetLinearSolver(memory, work.linear, nullptr), "ARKStepSetLinearSolver");
  if (options.linear != linear_solver::spgmr)
    require(ARKStepSetPreconditioner(memory, prepare_inverse, apply_inverse), "ARKStepSetPreconditioner");
  if (options.tuned) {
    require(ARKStepSetDeduceImplicitRhs(memory, SUNTRUE), "ARKStepSetDeduceImplicitRhs");
    require(ARKStepSetMaxNonlinIters(memory, 20), "ARKStepSetMaxNonlinIters");
  }
  if (options.longest > 0.0) require(ARKStepSetMaxStep(memory, options.longest), "ARKStepSetMaxStep");
  if (options.nonlinear > 0.0)
    require(ARKStepSetNonlinConvCoef(memory, options.nonlinear), "ARKStepSetNonlinConvCoef");
  if (options.constrained) {
    require(ARKStepSetConstraints(memory, work.constraints.get()), "ARKStepSetConstraints");
    require(ARKStepSetMaxNumConstrFails(memory, 100), "ARKStepSetMaxNumConstrFails");
  }
}

void set_up_cvode(workspace& work, system_of_equations& equations, double end,
                  const sundials_options& options) {
  void* memory = work.memory = CVodeCreate(CV_BDF, work.sundials.get());
  require(CVodeSetErrFile(memory, nullptr), "CVodeSetErrFile");
  require(CVodeInit(memory, both_sides, 0.0, work.y.get()), "CVodeInit");
  require(CVodeSetUserData(memory, &equations), "CVodeSetUserData");
  require(CVodeSStolerances(memory, options.rtol, options.atol), "CVodeSStolerances");
  require(CVodeSetMaxNumSteps(memory, many), "CVodeSetMaxNumSteps");
  require(CVodeSetStopTime(memory, end), "CVodeSetStopTime");
  require(CVodeSetLinearSolver(memory, work.linear, nullptr), "CVodeSetLinearSolver");
  if (options.linear != linear_solver::spgmr)
    require(CVodeSetPreconditioner(memory, prepare_inverse, apply_inverse), "CVodeSetPreconditioner");
  if (options.tuned) require(CVodeSetMaxNonlinIters(memory, 20), "CVodeSetMaxNonlinIters");
  if (options.nonlinear > 0.0)
    require(CVodeSetNonlinConvCoef(memory, options.nonlinear), "CVodeSetNonlinConvCoef");
  if (options.constrained)
    require(CVodeSetConstraints(memory, work.constraints.get()), "CVodeSetConstraints");
}

}  // namespace

outcome run_sundials(kinetic_task& task, const sundials_options& options, field* result) {
  system_of_equations equations{task.problem(), task.inverse()};
  workspace work(task.initial(), options);
  if (work.is_arkode)
    set_up_arkode(work, equations, task.end(), options);
  else
    set_up_cvode(work, equations, task.end(), options);
  run_monitor timer(options.seconds_allowed);
  const field& u = field_of(work.y.get());
  double t = 0.0;
  std::string failure;
  timer.start();
  while (t < task.end() && failure.empty()) {
    const int flag = work.is_arkode ? ARKStepEvolve(work.memory, task.end(), work.y.get(), &t, ARK_ONE_STEP)
                                    : CVode(work.memory, task.end(), work.y.get(), &t, CV_ONE_STEP);
    const bool in_time = timer.stepped(u);
    if (flag < 0)
      failure = "failed";
    else if (!in_time)
      failure = "too slow";
  }
  outcome measured = timer.result(u);
  measured.failure = failure;
  measured.error = task.error(u);
  if (!std::isfinite(measured.error) && failure.empty()) measured.failure = "failed";
  if (result != nullptr) *result = u;
  return measured;
}

}  // namespace apsis::bench::peers
