#include "integrate/reference.hpp"

#ifdef APSIS_HAVE_CVODE

#include <cmath>
#include <stdexcept>
#include <vector>

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

/// Integrates y to t_end. The right-hand side and the Jacobian receive `data`.
std::vector<double> integrate(int formula, CVRhsFn f, CVLsJacFn jacobian, void* data,
                              std::vector<double> start, double relative, const std::vector<double>& absolute,
                              double t_end) {
  SUNContext context = nullptr;
  require(SUNContext_Create(nullptr, &context), "SUNContext_Create");
  const auto n = static_cast<sunindextype>(start.size());
  N_Vector y = N_VNew_Serial(n, context), tolerances = N_VNew_Serial(n, context);
  for (sunindextype k = 0; k < n; ++k) {
    NV_Ith_S(y, k) = start[static_cast<std::size_t>(k)];
    NV_Ith_S(tolerances, k) = absolute[static_cast<std::size_t>(k)];
  }
  void* memory = CVodeCreate(formula, context);
  require(CVodeInit(memory, f, 0, y), "CVodeInit");
  require(CVodeSVtolerances(memory, relative, tolerances), "CVodeSVtolerances");
  require(CVodeSetUserData(memory, data), "CVodeSetUserData");
  require(CVodeSetMaxNumSteps(memory, 10000000), "CVodeSetMaxNumSteps");
  require(CVodeSetStopTime(memory, t_end), "CVodeSetStopTime");
  SUNMatrix matrix = SUNDenseMatrix(n, n, context);
  SUNLinearSolver solver = SUNLinSol_Dense(y, matrix, context);
  require(CVodeSetLinearSolver(memory, solver, matrix), "CVodeSetLinearSolver");
  require(CVodeSetJacFn(memory, jacobian), "CVodeSetJacFn");
  double t = 0;
  require(CVode(memory, t_end, y, &t, CV_NORMAL), "CVode");
  for (sunindextype k = 0; k < n; ++k) start[static_cast<std::size_t>(k)] = NV_Ith_S(y, k);
  CVodeFree(&memory);
  SUNLinSolFree(solver);
  SUNMatDestroy(matrix);
  N_VDestroy(y);
  N_VDestroy(tolerances);
  SUNContext_Free(&context);
  return start;
}

int robertson(realtype, N_Vector y, N_Vector out, void*) {
  const double first = -0.04 * NV_Ith_S(y, 0) + 1e4 * NV_Ith_S(y, 1) * NV_Ith_S(y, 2),
               third = 3e7 * NV_Ith_S(y, 1) * NV_Ith_S(y, 1);
  NV_Ith_S(out, 0) = first;
  NV_Ith_S(out, 1) = -first - third;
  NV_Ith_S(out, 2) = third;
  return 0;
}

int robertson_jacobian(realtype, N_Vector y, N_Vector, SUNMatrix m, void*, N_Vector, N_Vector, N_Vector) {
  const double by_second = 1e4 * NV_Ith_S(y, 2), by_third = 1e4 * NV_Ith_S(y, 1),
               squared = 6e7 * NV_Ith_S(y, 1);
  SM_ELEMENT_D(m, 0, 0) = -0.04;
  SM_ELEMENT_D(m, 0, 1) = by_second;
  SM_ELEMENT_D(m, 0, 2) = by_third;
  SM_ELEMENT_D(m, 1, 0) = 0.04;
  SM_ELEMENT_D(m, 1, 1) = -by_second - squared;
  SM_ELEMENT_D(m, 1, 2) = -by_third;
  SM_ELEMENT_D(m, 2, 0) = 0;
  SM_ELEMENT_D(m, 2, 1) = squared;
  SM_ELEMENT_D(m, 2, 2) = 0;
  return 0;
}

}  // namespace

pair cvode(double epsilon, double t_end) {
  const auto u = integrate(epsilon > 0.1 ? CV_ADAMS : CV_BDF, slope, jacobian, &epsilon, {2, 0}, 2e-15,
                           {1e-16, 1e-16}, t_end);
  return {u[0], u[1]};
}

std::array<double, 3> cvode_robertson(double t_end) {
  const auto u = integrate(CV_BDF, robertson, robertson_jacobian, nullptr, {1, 0, 0}, 1e-11,
                           {1e-18, 1e-24, 1e-14}, t_end);
  return {u[0], u[1], u[2]};
}

}  // namespace reference

#else

#include <limits>

namespace reference {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

pair cvode(double, double) {
  return {unknown, unknown};
}

std::array<double, 3> cvode_robertson(double) {
  return {unknown, unknown, unknown};
}

}  // namespace reference

#endif
