/* Robertson's problem with vectors and a dense solver of SUNDIALS, by a program in C. */
#include <apsis/apsis_sundials.h>

#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#ifndef SUN_COMM_NULL
#define SUN_COMM_NULL NULL /* before version 7 */
#endif

static int collision(sunrealtype t, N_Vector y, N_Vector ydot, void* data) {
  const sunrealtype* u = N_VGetArrayPointer(y);
  sunrealtype* q = N_VGetArrayPointer(ydot);
  (void)t;
  (void)data;
  q[0] = -0.04 * u[0] + 1e4 * u[1] * u[2];
  q[2] = 3e7 * u[1] * u[1];
  q[1] = -q[0] - q[2];
  return 0;
}

static int jacobian(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix j, void* data, N_Vector work1,
                    N_Vector work2, N_Vector work3) {
  const sunrealtype* u = N_VGetArrayPointer(y);
  (void)t, (void)fy, (void)data, (void)work1, (void)work2, (void)work3;
  SM_ELEMENT_D(j, 0, 0) = -0.04;
  SM_ELEMENT_D(j, 0, 1) = 1e4 * u[2];
  SM_ELEMENT_D(j, 0, 2) = 1e4 * u[1];
  SM_ELEMENT_D(j, 1, 0) = 0.04;
  SM_ELEMENT_D(j, 1, 1) = -1e4 * u[2] - 6e7 * u[1];
  SM_ELEMENT_D(j, 1, 2) = -1e4 * u[1];
  SM_ELEMENT_D(j, 2, 1) = 6e7 * u[1];
  return 0;
}

int main(void) {
  SUNContext context = NULL;
  N_Vector y;
  SUNMatrix a;
  SUNLinearSolver solver;
  apsis_method* method = NULL;
  apsis_sundials* s = NULL;
  int status;
  /* At t = 40, from Hairer and Wanner, Solving Ordinary Differential Equations II, section IV.10. */
  const double truth[3] = {0.7158270688, 0.9185534765e-5, 0.2841637457};
  int i;

  SUNContext_Create(SUN_COMM_NULL, &context);
  y = N_VNew_Serial(3, context);
  a = SUNDenseMatrix(3, 3, context);
  solver = SUNLinSol_Dense(y, a, context);
  N_VConst(0.0, y);
  N_VGetArrayPointer(y)[0] = 1.0;
  status = apsis_find_method("extrapolated-euler-5", &method);
  if (status == APSIS_OK) status = apsis_sundials_create(method, NULL, collision, 0.0, y, context, &s);
  if (status == APSIS_OK) status = apsis_sundials_set_linear_solver(s, solver, a);
  if (status == APSIS_OK) status = apsis_sundials_set_jacobian(s, jacobian);
  if (status == APSIS_OK) status = apsis_sundials_set_tolerance(s, 1e-6, 1e-12);
  if (status == APSIS_OK) status = apsis_sundials_evolve(s, 40.0, y, NULL);
  if (status != APSIS_OK) fprintf(stderr, "%s\n", apsis_error_message());
  for (i = 0; i < 3; ++i) {
    const double value = N_VGetArrayPointer(y)[i];
    printf("%.10g\n", value);
    /* A hundred steps have errors of about the tolerance. */
    if (!(fabs(value / truth[i] - 1.0) < 1e-5)) status = 1;
  }
  apsis_sundials_free(s);
  apsis_free_method(method);
  SUNLinSolFree(solver);
  SUNMatDestroy(a);
  N_VDestroy(y);
  SUNContext_Free(&context);
  return status;
}
