#include "field_vector.hpp"
#include "measure/clock.hpp"
#include "ode.hpp"

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
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

/// Seconds per call, averaged over enough calls for the resolution of the clock.
template <class Body>
double seconds_of(const Body& body) {
  constexpr double enough = 1e-3;
  for (long calls = 1;; calls *= 4) {
    const double begin = thread_seconds();
    for (long k = 0; k < calls; ++k) body();
    const double seconds = thread_seconds() - begin;
    if (seconds > enough) return seconds / static_cast<double>(calls);
  }
}

}  // namespace

outcome run_ode(const ode_task& task, const method& m, long steps, bool graded) {
  auto problem = ode_problem(task.epsilon);
  stepper march(m, problem);
  const auto rule = step_rule<double>::fixed(1.0 / static_cast<double>(steps))
                        .with(graded ? startup::graded : startup::none);
  outcome measured;
  measured.smallest = std::numeric_limits<double>::infinity();
  auto u = ode_initial(ode_data::inconsistent, task.epsilon);
  try {
    integrate(march, u, 0.0, 1.0, rule, [&](long step, double, double, const auto& now) {
      measured.smallest = std::min({measured.smallest, now[0], now[1]});
      measured.steps = step;
    });
    measured.seconds = seconds_of([&] {
      u = ode_initial(ode_data::inconsistent, task.epsilon);
      integrate(march, u, 0.0, 1.0, rule);
    });
  } catch (const numerical_error&) {
    measured.failure = "failed";
  }
  measured.error = ode_distance(u, task.exact);
  measured.smallest_final = std::min(u[0], u[1]);
  return measured;
}

namespace {

using integrator = sundials_ode_options::integrator;

int explicit_side(realtype, N_Vector y, N_Vector out, void*) {
  NV_Ith_S(out, 0) = NV_Ith_S(y, 1);
  NV_Ith_S(out, 1) = 0.0;
  return 0;
}

int implicit_side(realtype, N_Vector y, N_Vector out, void* data) {
  const double u1 = NV_Ith_S(y, 0), u2 = NV_Ith_S(y, 1);
  NV_Ith_S(out, 0) = 0.0;
  NV_Ith_S(out, 1) = (1.0 + u1 * u1) * (std::sin(u1) - u2) / *static_cast<const double*>(data);
  return 0;
}

int both_sides(realtype t, N_Vector y, N_Vector out, void* data) {
  implicit_side(t, y, out, data);
  NV_Ith_S(out, 0) = NV_Ith_S(y, 1);
  return 0;
}

int implicit_jacobian(realtype, N_Vector y, N_Vector, SUNMatrix m, void* data, N_Vector, N_Vector, N_Vector) {
  const double u1 = NV_Ith_S(y, 0), u2 = NV_Ith_S(y, 1), rate = 1.0 + u1 * u1;
  const double epsilon = *static_cast<const double*>(data);
  SM_ELEMENT_D(m, 0, 0) = 0.0;
  SM_ELEMENT_D(m, 0, 1) = 0.0;
  SM_ELEMENT_D(m, 1, 0) = (2.0 * u1 * (std::sin(u1) - u2) + rate * std::cos(u1)) / epsilon;
  SM_ELEMENT_D(m, 1, 1) = -rate / epsilon;
  return 0;
}

int whole_jacobian(realtype t, N_Vector y, N_Vector f, SUNMatrix m, void* data, N_Vector a, N_Vector b,
                   N_Vector c) {
  implicit_jacobian(t, y, f, m, data, a, b, c);
  SM_ELEMENT_D(m, 0, 1) = 1.0;
  return 0;
}

void require(int flag, const char* what) {
  if (flag < 0) throw std::runtime_error(std::string(what) + " failed");
}

/// An integrator of SUNDIALS with its resources.
class sundials_ode {
 public:
  sundials_ode(double epsilon, const sundials_ode_options& options)
      : epsilon_(epsilon),
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

  ode_state<double> value() const { return {NV_Ith_S(y_.get(), 0), NV_Ith_S(y_.get(), 1)}; }

 private:
  bool is_cvode() const { return options_.which == integrator::cvode; }
  ARKRhsFn explicit_part() const {
    return options_.which == integrator::arkode_imex ? explicit_side : nullptr;
  }
  ARKRhsFn implicit_part() const {
    return options_.which == integrator::arkode_imex ? implicit_side : both_sides;
  }

  void start() {
    NV_Ith_S(y_.get(), 0) = 2.0;
    NV_Ith_S(y_.get(), 1) = 0.0;
  }

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
    require(CVodeSetUserData(memory_, &epsilon_), "CVodeSetUserData");
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
    require(ARKStepSetUserData(memory_, &epsilon_), "ARKStepSetUserData");
    require(ARKStepSStolerances(memory_, options_.rtol, options_.atol), "ARKStepSStolerances");
    require(ARKStepSetOrder(memory_, options_.order), "ARKStepSetOrder");
    require(ARKStepSetMaxNumSteps(memory_, most_steps), "ARKStepSetMaxNumSteps");
    require(ARKStepSetLinearSolver(memory_, linear_, matrix_), "ARKStepSetLinearSolver");
    if (!options_.tuned) return;
    const bool imex = options_.which == integrator::arkode_imex;
    require(ARKStepSetJacFn(memory_, imex ? implicit_jacobian : whole_jacobian), "ARKStepSetJacFn");
    require(ARKStepSetDeduceImplicitRhs(memory_, SUNTRUE), "ARKStepSetDeduceImplicitRhs");
    if (options_.nonlinear > 0.0)
      require(ARKStepSetNonlinConvCoef(memory_, options_.nonlinear), "ARKStepSetNonlinConvCoef");
  }

  static constexpr long most_steps = 20000;  ///< limit on the number of steps
  double epsilon_;
  sundials_ode_options options_;
  owned_context context_ = make_context();
  owned_vector y_, constraints_;
  SUNMatrix matrix_;
  SUNLinearSolver linear_;
  void* memory_ = nullptr;
};

}  // namespace

outcome run_sundials_ode(const ode_task& task, const sundials_ode_options& options) {
  sundials_ode run(task.epsilon, options);
  outcome measured;
  if (!run.integrate_monitored(measured)) {
    measured.failure = "failed";
    return measured;
  }
  measured.seconds = seconds_of([&] { run.integrate(); });
  measured.error = ode_distance(run.value(), task.exact);
  measured.smallest_final = std::min(run.value()[0], run.value()[1]);
  return measured;
}

}  // namespace apsis::bench::peers
