#include "field_vector.hpp"
#include "sundials_ode.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include <arkode/arkode_arkstep.h>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

namespace apsis::bench::peers {
namespace {

using integrator = sundials_ode_options::integrator;

stiff_task::state state_of(N_Vector y) {
  return {NV_Ith_S(y, 0), NV_Ith_S(y, 1)};
}
const stiff_task& task_of(void* data) {
  return *static_cast<const stiff_task*>(data);
}

int store(const stiff_task::state& value, N_Vector out) {
  NV_Ith_S(out, 0) = value[0];
  NV_Ith_S(out, 1) = value[1];
  return 0;
}

int explicit_side(realtype, N_Vector y, N_Vector out, void* data) {
  return store(task_of(data).transport(state_of(y)), out);
}

int implicit_side(realtype, N_Vector y, N_Vector out, void* data) {
  return store(task_of(data).collision(state_of(y)), out);
}

int both_sides(realtype, N_Vector y, N_Vector out, void* data) {
  const auto u = state_of(y), slow = task_of(data).transport(u), fast = task_of(data).collision(u);
  return store({slow[0] + fast[0], slow[1] + fast[1]}, out);
}

int store(const Eigen::Matrix2d& value, SUNMatrix out) {
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) SM_ELEMENT_D(out, i, j) = value(i, j);
  return 0;
}

int implicit_jacobian(realtype, N_Vector y, N_Vector, SUNMatrix out, void* data, N_Vector, N_Vector,
                      N_Vector) {
  return store(task_of(data).collision_jacobian(state_of(y)), out);
}

int whole_jacobian(realtype, N_Vector y, N_Vector, SUNMatrix out, void* data, N_Vector, N_Vector, N_Vector) {
  const auto u = state_of(y);
  return store(task_of(data).transport_jacobian(u) + task_of(data).collision_jacobian(u), out);
}

void require(int flag, const char* what) {
  if (flag < 0) throw std::runtime_error(std::string(what) + " failed");
}

/// An integrator of SUNDIALS with its resources.
class sundials_ode {
 public:
  sundials_ode(const stiff_task& task, const sundials_ode_options& options)
      : task_(task),
        options_(options),
        y_(N_VNew_Serial(2, context_.get())),
        constraints_(N_VNew_Serial(2, context_.get())),
        matrix_(SUNDenseMatrix(2, 2, context_.get())),
        linear_(SUNLinSol_Dense(y_.get(), matrix_, context_.get())) {
    N_VConst(1.0, constraints_.get());
    start();
    is_cvode() ? set_up_cvode() : set_up_arkode();
  }
  sundials_ode(const sundials_ode&) = delete;
  sundials_ode& operator=(const sundials_ode&) = delete;
  ~sundials_ode() {
    if (memory_ != nullptr) is_cvode() ? CVodeFree(&memory_) : ARKStepFree(&memory_);
    SUNLinSolFree(linear_);
    SUNMatDestroy(matrix_);
  }

  /// Integrates from t = 0 to 1; returns false if that fails.
  bool integrate() {
    restart();
    double t = 0.0;
    return (is_cvode() ? CVode(memory_, 1.0, y_.get(), &t, CV_NORMAL)
                       : ARKStepEvolve(memory_, 1.0, y_.get(), &t, ARK_NORMAL)) >= 0;
  }

  /// Integrates step by step to monitor all values.
  bool integrate_monitored(outcome& measured) {
    restart();
    measured.smallest = std::numeric_limits<double>::infinity();
    for (double t = 0.0; t < 1.0; ++measured.steps) {
      const int flag = is_cvode() ? CVode(memory_, 1.0, y_.get(), &t, CV_ONE_STEP)
                                  : ARKStepEvolve(memory_, 1.0, y_.get(), &t, ARK_ONE_STEP);
      if (flag < 0 || measured.steps >= most_steps) return false;
      measured.smallest = std::min({measured.smallest, value()[0], value()[1]});
    }
    return true;
  }

  stiff_task::state value() const { return state_of(y_.get()); }

 private:
  bool is_cvode() const { return options_.which == integrator::cvode; }
  ARKRhsFn explicit_part() const {
    if (options_.which == integrator::arkode_explicit) return both_sides;
    return options_.which == integrator::arkode_imex ? explicit_side : nullptr;
  }
  ARKRhsFn implicit_part() const {
    if (options_.which == integrator::arkode_explicit) return nullptr;
    return options_.which == integrator::arkode_imex ? implicit_side : both_sides;
  }

  void start() { store(task_.initial(), y_.get()); }
  void* data() const { return const_cast<stiff_task*>(&task_); }  // SUNDIALS has no pointers to constants

  void restart() {
    start();
    if (is_cvode()) {
      require(CVodeReInit(memory_, 0.0, y_.get()), "CVodeReInit");
      require(CVodeSetStopTime(memory_, 1.0), "CVodeSetStopTime");
    } else {
      require(ARKStepReInit(memory_, explicit_part(), implicit_part(), 0.0, y_.get()), "ARKStepReInit");
      require(ARKStepSetStopTime(memory_, 1.0), "ARKStepSetStopTime");
    }
  }

  void set_up_cvode() {
    memory_ = CVodeCreate(CV_BDF, context_.get());
    require(CVodeSetErrFile(memory_, nullptr), "CVodeSetErrFile");
    require(CVodeInit(memory_, both_sides, 0.0, y_.get()), "CVodeInit");
    require(CVodeSetUserData(memory_, data()), "CVodeSetUserData");
    require(CVodeSStolerances(memory_, options_.rtol, options_.atol), "CVodeSStolerances");
    require(CVodeSetMaxNumSteps(memory_, most_steps), "CVodeSetMaxNumSteps");
    require(CVodeSetLinearSolver(memory_, linear_, matrix_), "CVodeSetLinearSolver");
    if (options_.tuned) require(CVodeSetJacFn(memory_, whole_jacobian), "CVodeSetJacFn");
    if (options_.nonlinear > 0.0)
      require(CVodeSetNonlinConvCoef(memory_, options_.nonlinear), "CVodeSetNonlinConvCoef");
    if (options_.constrained)
      require(CVodeSetConstraints(memory_, constraints_.get()), "CVodeSetConstraints");
  }

  void set_up_arkode() {
    memory_ = ARKStepCreate(explicit_part(), implicit_part(), 0.0, y_.get(), context_.get());
    require(ARKStepSetErrFile(memory_, nullptr), "ARKStepSetErrFile");
    require(ARKStepSetUserData(memory_, data()), "ARKStepSetUserData");
    require(ARKStepSStolerances(memory_, options_.rtol, options_.atol), "ARKStepSStolerances");
    require(ARKStepSetOrder(memory_, options_.order), "ARKStepSetOrder");
    require(ARKStepSetMaxNumSteps(memory_, most_steps), "ARKStepSetMaxNumSteps");
    if (options_.which == integrator::arkode_explicit) return;
    require(ARKStepSetLinearSolver(memory_, linear_, matrix_), "ARKStepSetLinearSolver");
    if (!options_.tuned) return;
    const bool imex = options_.which == integrator::arkode_imex;
    require(ARKStepSetJacFn(memory_, imex ? implicit_jacobian : whole_jacobian), "ARKStepSetJacFn");
    require(ARKStepSetDeduceImplicitRhs(memory_, SUNTRUE), "ARKStepSetDeduceImplicitRhs");
    if (options_.nonlinear > 0.0)
      require(ARKStepSetNonlinConvCoef(memory_, options_.nonlinear), "ARKStepSetNonlinConvCoef");
  }

  static constexpr long most_steps = 20000;  ///< limit on the number of steps
  const stiff_task& task_;
  sundials_ode_options options_;
  owned_context context_ = make_context();
  owned_vector y_, constraints_;
  SUNMatrix matrix_;
  SUNLinearSolver linear_;
  void* memory_ = nullptr;
};

}  // namespace

outcome run_sundials_ode(const stiff_task& task, const sundials_ode_options& options) {
  sundials_ode run(task, options);
  outcome measured;
  if (!run.integrate_monitored(measured)) {
    measured.failure = "failed";
    return measured;
  }
  measured.seconds = seconds_per_call([&] { run.integrate(); });
  measured.error = task.error(run.value());
  measured.smallest_final = std::min(run.value()[0], run.value()[1]);
  return measured;
}

}  // namespace apsis::bench::peers
