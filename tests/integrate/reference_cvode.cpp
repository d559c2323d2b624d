#include "integrate/reference.hpp"

#include <cmath>
#include <memory>
#include <stdexcept>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

namespace reference {
namespace {

int slope(realtype, N_Vector y, N_Vector out, void* data) {
  const double epsilon = *static_cast<const double*>(data);
  const double u1 = NV_Ith_S(y, 0), u2 = NV_Ith_S(y, 1);
  NV_Ith_S(out, 0) = u2;
  NV_Ith_S(out, 1) = (1 + u1 * u1) * (std::sin(u1) - u2) / epsilon;
  return 0;
}

int jacobian(realtype, N_Vector y, N_Vector, SUNMatrix m, void* data, N_Vector, N_Vector, N_Vector) {
  const double epsilon = *static_cast<const double*>(data);
  const double u1 = NV_Ith_S(y, 0), u2 = NV_Ith_S(y, 1), rate = 1 + u1 * u1;
  SM_ELEMENT_D(m, 0, 0) = 0;
  SM_ELEMENT_D(m, 0, 1) = 1;
  SM_ELEMENT_D(m, 1, 0) = (2 * u1 * (std::sin(u1) - u2) + rate * std::cos(u1)) / epsilon;
  SM_ELEMENT_D(m, 1, 1) = -rate / epsilon;
  return 0;
}

void require(int flag, const char* what) {
  if (flag < 0) throw std::runtime_error(what);
}

}  // namespace

pair cvode(double epsilon, double t_end) {
  SUNContext context = nullptr;
  require(SUNContext_Create(nullptr, &context), "SUNContext_Create");
  N_Vector y = N_VNew_Serial(2, context);
  NV_Ith_S(y, 0) = 2;
  NV_Ith_S(y, 1) = 0;
  void* memory = CVodeCreate(epsilon > 0.1 ? CV_ADAMS : CV_BDF, context);
  require(CVodeInit(memory, slope, 0, y), "CVodeInit");
  require(CVodeSStolerances(memory, 2e-15, 1e-16), "CVodeSStolerances");
  require(CVodeSetUserData(memory, &epsilon), "CVodeSetUserData");
  require(CVodeSetMaxNumSteps(memory, 10000000), "CVodeSetMaxNumSteps");
  require(CVodeSetStopTime(memory, t_end), "CVodeSetStopTime");
  SUNMatrix matrix = SUNDenseMatrix(2, 2, context);
  SUNLinearSolver solver = SUNLinSol_Dense(y, matrix, context);
  require(CVodeSetLinearSolver(memory, solver, matrix), "CVodeSetLinearSolver");
  require(CVodeSetJacFn(memory, jacobian), "CVodeSetJacFn");
  double t = 0;
  require(CVode(memory, t_end, y, &t, CV_NORMAL), "CVode");
  const pair u{NV_Ith_S(y, 0), NV_Ith_S(y, 1)};
  CVodeFree(&memory);
  SUNLinSolFree(solver);
  SUNMatDestroy(matrix);
  N_VDestroy(y);
  SUNContext_Free(&context);
  return u;
}

}  // namespace reference
