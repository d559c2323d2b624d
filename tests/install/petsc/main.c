/* u1' = u2,  u2' = (1 + u1^2)(sin u1 - u2)/epsilon with epsilon = 1e-8, in steps of 1/64. */
#include <apsis/apsis_petsc.h>

static const PetscReal epsilon = 1e-8;

/* T = (u2, 0) */
static PetscErrorCode transport(TS ts, PetscReal t, Vec state, Vec out, void* context) {
  const PetscScalar* u;
  PetscScalar* T;
  PetscFunctionBeginUser;
  (void)ts, (void)t, (void)context;
  PetscCall(VecGetArrayRead(state, &u));
  PetscCall(VecGetArray(out, &T));
  T[0] = u[1];
  T[1] = 0;
  PetscCall(VecRestoreArray(out, &T));
  PetscCall(VecRestoreArrayRead(state, &u));
  PetscFunctionReturn(0);
}

/* F = u' - Q with Q = (0, (1 + u1^2)(sin u1 - u2)/epsilon) */
static PetscErrorCode collision(TS ts, PetscReal t, Vec state, Vec rate, Vec out, void* context) {
  const PetscScalar *u, *dot;
  PetscScalar* F;
  PetscFunctionBeginUser;
  (void)ts, (void)t, (void)context;
  PetscCall(VecGetArrayRead(state, &u));
  PetscCall(VecGetArrayRead(rate, &dot));
  PetscCall(VecGetArray(out, &F));
  F[0] = dot[0];
  F[1] = dot[1] - (1 + u[0] * u[0]) * (PetscSinReal(u[0]) - u[1]) / epsilon;
  PetscCall(VecRestoreArray(out, &F));
  PetscCall(VecRestoreArrayRead(rate, &dot));
  PetscCall(VecRestoreArrayRead(state, &u));
  PetscFunctionReturn(0);
}

/* shift + dF/du */
static PetscErrorCode jacobian(TS ts, PetscReal t, Vec state, Vec rate, PetscReal shift, Mat A, Mat P,
                               void* context) {
  const PetscInt rows[] = {0, 1};
  const PetscScalar* u;
  PetscScalar entries[] = {shift, 0, 0, shift};
  PetscFunctionBeginUser;
  (void)ts, (void)t, (void)rate, (void)A, (void)context;
  PetscCall(VecGetArrayRead(state, &u));
  entries[2] = -(2 * u[0] * (PetscSinReal(u[0]) - u[1]) + (1 + u[0] * u[0]) * PetscCosReal(u[0])) / epsilon;
  entries[3] += (1 + u[0] * u[0]) / epsilon;
  PetscCall(VecRestoreArrayRead(state, &u));
  PetscCall(MatSetValues(P, 2, rows, 2, rows, entries, INSERT_VALUES));
  PetscCall(MatAssemblyBegin(P, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(P, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

int main(int argc, char** argv) {
  TS ts;
  Vec state;
  Mat J;
  const PetscScalar* u;
  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TSApsisRegister());
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, 2, &state));
  PetscCall(VecSetValue(state, 0, 2, INSERT_VALUES));
  PetscCall(VecAssemblyBegin(state));
  PetscCall(VecAssemblyEnd(state));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, 2, 2, NULL, &J));
  PetscCall(TSCreate(PETSC_COMM_SELF, &ts));
  PetscCall(TSSetRHSFunction(ts, NULL, transport, NULL));
  PetscCall(TSSetIFunction(ts, NULL, collision, NULL));
  PetscCall(TSSetIJacobian(ts, J, J, jacobian, NULL));
  PetscCall(TSSetTimeStep(ts, 1.0 / 64));
  PetscCall(TSSetMaxTime(ts, 1));
  PetscCall(TSSetExactFinalTime(ts, TS_EXACTFINALTIME_MATCHSTEP));
  PetscCall(TSSetType(ts, TSAPSIS));
  PetscCall(TSApsisSetMethod(ts, "md-imex-6-3"));
  PetscCall(TSSetFromOptions(ts));
  PetscCall(TSSolve(ts, state));
  PetscCall(VecGetArrayRead(state, &u));
  PetscCall(PetscPrintf(PETSC_COMM_SELF, "u(1) = (%.6f, %.6f)\n", u[0], u[1]));
  PetscCall(VecRestoreArrayRead(state, &u));
  PetscCall(TSDestroy(&ts));
  PetscCall(MatDestroy(&J));
  PetscCall(VecDestroy(&state));
  PetscCall(PetscFinalize());
  return 0;
}
