/* A program of PETSc without any code of Apsis. It solves u_t + u_x = (v - u^2)/epsilon and
 * v_t = -(v - u^2)/epsilon on a periodic line. It prints the type of the time stepper, the time reached and
 * the norm of the solution. */
#include <petscdm.h>
#include <petscdmda.h>
#include <petscts.h>

typedef struct {
  PetscScalar u, v;
} point;

static PetscReal epsilon = 1e-6;

static PetscErrorCode transport(TS ts, PetscReal t, Vec state, Vec out, void* context) {
  DM da;
  Vec local;
  point *u, *f;
  PetscInt i, begin, count, all;
  PetscFunctionBeginUser;
  (void)t, (void)context;
  PetscCall(TSGetDM(ts, &da));
  PetscCall(DMGetLocalVector(da, &local));
  PetscCall(DMGlobalToLocal(da, state, INSERT_VALUES, local));
  PetscCall(DMDAVecGetArrayRead(da, local, &u));
  PetscCall(DMDAVecGetArray(da, out, &f));
  PetscCall(DMDAGetCorners(da, &begin, NULL, NULL, &count, NULL, NULL));
  PetscCall(DMDAGetInfo(da, NULL, &all, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL));
  for (i = begin; i < begin + count; ++i) {
    f[i].u = -(PetscReal)all * (u[i].u - u[i - 1].u);
    f[i].v = 0;
  }
  PetscCall(DMDAVecRestoreArrayRead(da, local, &u));
  PetscCall(DMDAVecRestoreArray(da, out, &f));
  PetscCall(DMRestoreLocalVector(da, &local));
  PetscFunctionReturn(0);
}

static PetscErrorCode exchange(TS ts, PetscReal t, Vec state, Vec rate, Vec out, void* context) {
  DM da;
  point *u, *dot, *f;
  PetscInt i, begin, count;
  PetscFunctionBeginUser;
  (void)t, (void)context;
  PetscCall(TSGetDM(ts, &da));
  PetscCall(DMDAVecGetArrayRead(da, state, &u));
  PetscCall(DMDAVecGetArrayRead(da, rate, &dot));
  PetscCall(DMDAVecGetArray(da, out, &f));
  PetscCall(DMDAGetCorners(da, &begin, NULL, NULL, &count, NULL, NULL));
  for (i = begin; i < begin + count; ++i) {
    const PetscScalar q = (u[i].v - u[i].u * u[i].u) / epsilon;
    f[i].u = dot[i].u - q;
    f[i].v = dot[i].v + q;
  }
  PetscCall(DMDAVecRestoreArrayRead(da, state, &u));
  PetscCall(DMDAVecRestoreArrayRead(da, rate, &dot));
  PetscCall(DMDAVecRestoreArray(da, out, &f));
  PetscFunctionReturn(0);
}

int main(int argc, char** argv) {
  TS ts;
  DM da;
  Vec state;
  TSType type;
  point* u;
  PetscReal t, norm;
  PetscInt i, begin, count, all;
  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-epsilon", &epsilon, NULL));
  PetscCall(DMDACreate1d(PETSC_COMM_WORLD, DM_BOUNDARY_PERIODIC, 60, 2, 1, NULL, &da));
  PetscCall(DMSetFromOptions(da));
  PetscCall(DMSetUp(da));
  PetscCall(DMCreateGlobalVector(da, &state));
  PetscCall(DMDAVecGetArray(da, state, &u));
  PetscCall(DMDAGetCorners(da, &begin, NULL, NULL, &count, NULL, NULL));
  PetscCall(DMDAGetInfo(da, NULL, &all, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL));
  for (i = begin; i < begin + count; ++i) {
    u[i].u = 1 + 0.5 * PetscSinReal(2 * PETSC_PI * ((PetscReal)i + 0.5) / (PetscReal)all);
    u[i].v = u[i].u * u[i].u;
  }
  PetscCall(DMDAVecRestoreArray(da, state, &u));
  PetscCall(TSCreate(PETSC_COMM_WORLD, &ts));
  PetscCall(TSSetDM(ts, da));
  PetscCall(TSSetRHSFunction(ts, NULL, transport, NULL));
  PetscCall(TSSetIFunction(ts, NULL, exchange, NULL));
  PetscCall(TSSetMaxTime(ts, 0.5));
  PetscCall(TSSetTimeStep(ts, 1.0 / 128));
  PetscCall(TSSetExactFinalTime(ts, TS_EXACTFINALTIME_MATCHSTEP));
  PetscCall(TSSetType(ts, TSARKIMEX));
  PetscCall(TSSetFromOptions(ts));
  PetscCall(TSSolve(ts, state));
  PetscCall(TSGetType(ts, &type));
  PetscCall(TSGetSolveTime(ts, &t));
  PetscCall(VecNorm(state, NORM_2, &norm));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s: t = %g, norm %.6f\n", type, (double)t, (double)norm));
  PetscCall(TSDestroy(&ts));
  PetscCall(VecDestroy(&state));
  PetscCall(DMDestroy(&da));
  PetscCall(PetscFinalize());
  return 0;
}
