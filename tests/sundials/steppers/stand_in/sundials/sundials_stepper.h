// Stands in for the header of the same name in SUNDIALS 7.5, where an older SUNDIALS is installed. It
// declares the part of the interface that Apsis and its tests use, after the section "The SUNStepper API" of
// the documentation of SUNDIALS 7.5 (https://sundials.readthedocs.io). stand_in/stepper.cpp defines it.
#pragma once

#include <sundials/sundials_nvector.h>
#include <sundials/sundials_types.h>

#ifdef __cplusplus
extern "C" {
#endif

// Types of version 7 ------------------------------------------------------------------------------------

typedef int SUNErrCode;
typedef long suncountertype;
enum { SUN_SUCCESS = 0, SUN_ERR_EXT_FAIL = -1 };

// Steppers --------------------------------------------------------------------------------------------------

typedef struct SUNStepper_* SUNStepper;
typedef enum { SUN_FULLRHS_START, SUN_FULLRHS_END, SUN_FULLRHS_OTHER } SUNFullRhsMode;

typedef SUNErrCode (*SUNStepperEvolveFn)(SUNStepper, sunrealtype tout, N_Vector, sunrealtype* tret);
typedef SUNErrCode (*SUNStepperOneStepFn)(SUNStepper, sunrealtype tout, N_Vector, sunrealtype* tret);
typedef SUNErrCode (*SUNStepperFullRhsFn)(SUNStepper, sunrealtype t, N_Vector v, N_Vector f, SUNFullRhsMode);
typedef SUNErrCode (*SUNStepperReInitFn)(SUNStepper, sunrealtype t, N_Vector);
typedef SUNErrCode (*SUNStepperResetFn)(SUNStepper, sunrealtype t, N_Vector);
typedef SUNErrCode (*SUNStepperSetStopTimeFn)(SUNStepper, sunrealtype tstop);
typedef SUNErrCode (*SUNStepperGetNumStepsFn)(SUNStepper, suncountertype* steps);

SUNErrCode SUNStepper_Create(SUNContext, SUNStepper*);
SUNErrCode SUNStepper_Destroy(SUNStepper*);
SUNErrCode SUNStepper_SetContent(SUNStepper, void*);
SUNErrCode SUNStepper_GetContent(SUNStepper, void**);
SUNErrCode SUNStepper_SetLastFlag(SUNStepper, int);
SUNErrCode SUNStepper_GetLastFlag(SUNStepper, int*);

SUNErrCode SUNStepper_SetEvolveFn(SUNStepper, SUNStepperEvolveFn);
SUNErrCode SUNStepper_SetOneStepFn(SUNStepper, SUNStepperOneStepFn);
SUNErrCode SUNStepper_SetFullRhsFn(SUNStepper, SUNStepperFullRhsFn);
SUNErrCode SUNStepper_SetReInitFn(SUNStepper, SUNStepperReInitFn);
SUNErrCode SUNStepper_SetResetFn(SUNStepper, SUNStepperResetFn);
SUNErrCode SUNStepper_SetStopTimeFn(SUNStepper, SUNStepperSetStopTimeFn);
SUNErrCode SUNStepper_SetGetNumStepsFn(SUNStepper, SUNStepperGetNumStepsFn);

SUNErrCode SUNStepper_Evolve(SUNStepper, sunrealtype tout, N_Vector, sunrealtype* tret);
SUNErrCode SUNStepper_OneStep(SUNStepper, sunrealtype tout, N_Vector, sunrealtype* tret);
SUNErrCode SUNStepper_FullRhs(SUNStepper, sunrealtype t, N_Vector v, N_Vector f, SUNFullRhsMode);
SUNErrCode SUNStepper_ReInit(SUNStepper, sunrealtype t, N_Vector);
SUNErrCode SUNStepper_Reset(SUNStepper, sunrealtype t, N_Vector);
SUNErrCode SUNStepper_SetStopTime(SUNStepper, sunrealtype tstop);
SUNErrCode SUNStepper_GetNumSteps(SUNStepper, suncountertype* steps);

// Control of the stand-in by tests --------------------------------------------------------------------------

/// Number of steppers that were created and not destroyed.
extern int stand_in_steppers;
/// The call of SUNStepper_Create() or SUNStepper_Set…() that fails, counted from 1; 0 if none does.
extern int stand_in_failing_call;

#ifdef __cplusplus
}
#endif
