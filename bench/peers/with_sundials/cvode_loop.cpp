// CVODE for one small system after the other, as a program without ensembles would call it.
#include "field_vector.hpp"
#include "peers/ensembles.hpp"

#include <algorithm>
#include <cmath>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

namespace apsis::bench::peers {
namespace cvode_loop {
namespace {

const double* parameters_of(void* data) {
  return *static_cast<const double**>(data);
}

int robertson(realtype, N_Vector at, N_Vector out, void* data) {
  const double *y = N_VGetArrayPointer(at), *k = parameters_of(data);
  double* f = N_VGetArrayPointer(out);
  f[0] = k[1] * y[1] * y[2] - k[0] * y[0];
  f[2] = k[2] * y[1] * y[1];
  f[1] = -f[0] - f[2];
  return 0;
}

int robertson_jacobian(realtype, N_Vector at, N_Vector, SUNMatrix out, void* data, N_Vector, N_Vector,
                       N_Vector) {
  const double *y = N_VGetArrayPointer(at), *k = parameters_of(data);
  const double rows[3][3] = {{-k[0], k[1] * y[2], k[1] * y[1]},
                             {k[0], -k[1] * y[2] - 2 * k[2] * y[1], -k[1] * y[1]},
                             {0, 2 * k[2] * y[1], 0}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) SM_ELEMENT_D(out, i, j) = rows[i][j];
  return 0;
}

int ode_model(realtype, N_Vector at, N_Vector out, void* data) {
  const double *y = N_VGetArrayPointer(at), epsilon = *parameters_of(data);
  double* f = N_VGetArrayPointer(out);
  f[0] = y[1];
  f[1] = (y[0] * y[0] + 1) * (std::sin(y[0]) - y[1]) / epsilon;
  return 0;
}

int ode_model_jacobian(realtype, N_Vector at, N_Vector, SUNMatrix out, void* data, N_Vector, N_Vector,
                       N_Vector) {
  const double *y = N_VGetArrayPointer(at), epsilon = *parameters_of(data), c = y[0] * y[0] + 1;
  SM_ELEMENT_D(out, 0, 0) = 0;
  SM_ELEMENT_D(out, 0, 1) = 1;
  SM_ELEMENT_D(out, 1, 0) = (2 * y[0] * (std::sin(y[0]) - y[1]) + c * std::cos(y[0])) / epsilon;
  SM_ELEMENT_D(out, 1, 1) = -c / epsilon;
  return 0;
}

/// CVODE with a dense solver for systems of one form.
class loop {
 public:
  loop(const ensemble_task& task, double rtol, CVRhsFn rate, CVLsJacFn jacobian)
      : task_(task),
        y_(N_VNew_Serial(static_cast<sunindextype>(task.unknowns), context_.get())),
        absolute_(N_VClone(y_.get())),
        matrix_(SUNDenseMatrix(static_cast<sunindextype>(task.unknowns),
                               static_cast<sunindextype>(task.unknowns), context_.get())),
        linear_(SUNLinSol_Dense(y_.get(), matrix_, context_.get())),
        memory_(CVodeCreate(CV_BDF, context_.get())) {
    for (std::size_t i = 0; i < task.unknowns; ++i) {
      N_VGetArrayPointer(absolute_.get())[i] = rtol * task.sizes[i];
      N_VGetArrayPointer(y_.get())[i] = task.start[i];
    }
    works_ = CVodeInit(memory_, rate, 0.0, y_.get()) == 0 &&
             CVodeSVtolerances(memory_, rtol, absolute_.get()) == 0 &&
             CVodeSetLinearSolver(memory_, linear_, matrix_) == 0 && CVodeSetJacFn(memory_, jacobian) == 0 &&
             CVodeSetUserData(memory_, &parameters_) == 0 && CVodeSetMaxNumSteps(memory_, 100000) == 0 &&
             CVodeSetErrFile(memory_, nullptr) == 0;
  }
  loop(const loop&) = delete;
  loop& operator=(const loop&) = delete;
  ~loop() {
    CVodeFree(&memory_);
    SUNLinSolFree(linear_);
    SUNMatDestroy(matrix_);
  }

  bool integrate(double* u, const double* parameters) {
    parameters_ = parameters;
    double* y = N_VGetArrayPointer(y_.get());
    std::copy_n(u, task_.unknowns, y);
    double t = 0.0;
    const bool ended = works_ && CVodeReInit(memory_, 0.0, y_.get()) == 0 &&
                       CVodeSetStopTime(memory_, task_.t1) == 0 &&
                       CVode(memory_, task_.t1, y_.get(), &t, CV_NORMAL) >= 0;
    std::copy_n(y, task_.unknowns, u);
    return ended;
  }

 private:
  const ensemble_task& task_;
  owned_context context_ = make_context();
  owned_vector y_, absolute_;
  SUNMatrix matrix_;
  SUNLinearSolver linear_;
  void* memory_;
  const double* parameters_ = nullptr;
  bool works_ = false;
};

template <CVRhsFn rate, CVLsJacFn jacobian>
bool integrate_all(const ensemble_task& task, double rtol, std::span<double> u,
                   std::span<const double> parameters) {
  loop one(task, rtol, rate, jacobian);
  for (std::size_t s = 0; s * task.unknowns < u.size(); ++s)
    if (!one.integrate(&u[s * task.unknowns], &parameters[s * task.parameters])) return false;
  return true;
}

double varied(std::size_t s, std::size_t systems) {
  return 1.0 + 0.3 * std::sin(6.28 * static_cast<double>(s) / static_cast<double>(systems));
}

}  // namespace
}  // namespace cvode_loop

ensemble_task robertson_ensemble() {
  return {.name = "Robertson to 1e11",
          .unknowns = 3,
          .parameters = 3,
          .t1 = 1e11,
          .start = {1, 0, 0},
          .sizes = {1e-4, 1e-8, 1e-4},
          .parameters_of =
              [](std::size_t s, std::size_t systems) {
                const double part = cvode_loop::varied(s, systems);
                return std::vector<double>{0.04 * part, 1e4 / part, 3e7 * part};
              },
          .in_lanes = robertson_in_lanes,
          .by_cvode = cvode_loop::integrate_all<cvode_loop::robertson, cvode_loop::robertson_jacobian>};
}

ensemble_task ode_model_ensemble() {
  return {.name = "ODE model, ε = 1e-4",
          .unknowns = 2,
          .parameters = 1,
          .t1 = 1,
          .start = {2, 0},
          .sizes = {1, 1},
          .parameters_of =
              [](std::size_t s, std::size_t systems) {
                return std::vector<double>{1e-4 * cvode_loop::varied(s, systems)};
              },
          .in_lanes = ode_model_in_lanes,
          .by_cvode = cvode_loop::integrate_all<cvode_loop::ode_model, cvode_loop::ode_model_jacobian>};
}

}  // namespace apsis::bench::peers
