/// A time stepper of PETSc, TS type "apsis": the methods of Apsis for u' = T(t, u) + Q(t, u).
///
/// T is the RHSFunction of the TS. The IFunction F(t, u, u') = u' − Q(t, u) and its IJacobian define the
/// stiff part Q; other mass matrices and DAEs are refused. Methods for stiff parts alone treat the
/// RHSFunction, with its RHSJacobian, as a part of Q. docs/petsc.md has the options and an example.
///
/// Functions return a PetscErrorCode, and are collective like those of PETSc.
#ifndef APSIS_APSIS_PETSC_H
#define APSIS_APSIS_PETSC_H

#include <petscts.h>

/// Version of the binary interface, part of the name of the library file. The library also requires the
/// version of PETSc with which it was built.
#define APSIS_PETSC_ABI_VERSION 1

/// The type for TSSetType() and -ts_type.
#define TSAPSIS "apsis"

#ifdef __cplusplus
extern "C" {
#endif

/// Registers the type "apsis"; call it after PetscInitialize(). Programs that load the library by -dll_append
/// do not need it. Error: PETSC_ERR_SUP if the version of PETSc differs from that of the build.
PetscErrorCode TSApsisRegister(void);

/// Sets the method; also -ts_apsis_method. `name` is a method of the catalogue, a member of a family, or a
/// method file FILE.toml. The method must have one step, and implicit or explicit stages. Ignored by other
/// types of TS. Errors: PETSC_ERR_ARG_WRONG with the nearest name, or with the reason why the method cannot
/// be used.
PetscErrorCode TSApsisSetMethod(TS ts, const char* name);
/// Sets *name to the name of the method, which is valid until another method is set. Error:
/// PETSC_ERR_ARG_WRONG if the type is not "apsis".
PetscErrorCode TSApsisGetMethod(TS ts, const char** name);

/// Chooses whether the RHSFunction is a part of Q, with its RHSJacobian; also -ts_apsis_fully_implicit.
/// Methods for stiff parts alone always do so. Ignored by other types of TS.
PetscErrorCode TSApsisSetFullyImplicit(TS ts, PetscBool fully_implicit);

/// *dt ← Δt_FE(t, u) > 0, the longest forward Euler step of the RHSFunction that preserves a property of u.
typedef PetscErrorCode TSApsisForwardEulerStep(TS ts, PetscReal t, Vec u, PetscReal* dt, void* ctx);
/// Limits steps to r Δt_FE, where r is the SSP coefficient of the method. They then preserve what forward
/// Euler steps and stage solves preserve. NULL removes the limit. -ts_apsis_ssp_step sets a constant Δt_FE.
/// Ignored by other types of TS. Steps end with PETSC_ERR_ARG_WRONG if the method has no SSP coefficient.
PetscErrorCode TSApsisSetForwardEulerStep(TS ts, TSApsisForwardEulerStep* function, void* ctx);

/// Called by PETSc when it loads the library as a plug-in; registers the type.
PetscErrorCode PetscDLLibraryRegister_apsis_petsc(void);

#ifdef __cplusplus
}
#endif

#endif
