// Steppers that store functions and call them, as the base class of SUNDIALS does.
#include <sundials/sundials_stepper.h>

struct SUNStepper_ {
  void* content = nullptr;
  int flag = 0;
  SUNStepperEvolveFn evolve = nullptr;
  SUNStepperOneStepFn one_step = nullptr;
  SUNStepperFullRhsFn full_rhs = nullptr;
  SUNStepperReInitFn reinit = nullptr;
  SUNStepperResetFn reset = nullptr;
  SUNStepperSetStopTimeFn stop = nullptr;
  SUNStepperGetNumStepsFn steps = nullptr;
};

int stand_in_steppers = 0, stand_in_failing_call = 0;

namespace {

constexpr SUNErrCode refused = -2;

/// Returns whether this call succeeds.
bool succeeds() {
  return stand_in_failing_call == 0 || --stand_in_failing_call > 0;
}

template <class T>
SUNErrCode store(T& to, T value) {
  if (!succeeds()) return refused;
  to = value;
  return SUN_SUCCESS;
}

template <class Function, class... Arguments>
SUNErrCode call(Function* function, Arguments... arguments) {
  return function != nullptr ? function(arguments...) : refused;
}

}  // namespace

SUNErrCode SUNStepper_Create(SUNContext, SUNStepper* made) {
  if (!succeeds()) return refused;
  *made = new SUNStepper_;
  ++stand_in_steppers;
  return SUN_SUCCESS;
}
SUNErrCode SUNStepper_Destroy(SUNStepper* s) {
  delete *s;
  *s = nullptr;
  --stand_in_steppers;
  return SUN_SUCCESS;
}
SUNErrCode SUNStepper_SetContent(SUNStepper s, void* content) {
  return store(s->content, content);
}
SUNErrCode SUNStepper_GetContent(SUNStepper s, void** content) {
  *content = s->content;
  return SUN_SUCCESS;
}
SUNErrCode SUNStepper_SetLastFlag(SUNStepper s, int flag) {
  s->flag = flag;
  return SUN_SUCCESS;
}
SUNErrCode SUNStepper_GetLastFlag(SUNStepper s, int* flag) {
  *flag = s->flag;
  return SUN_SUCCESS;
}

SUNErrCode SUNStepper_SetEvolveFn(SUNStepper s, SUNStepperEvolveFn f) {
  return store(s->evolve, f);
}
SUNErrCode SUNStepper_SetOneStepFn(SUNStepper s, SUNStepperOneStepFn f) {
  return store(s->one_step, f);
}
SUNErrCode SUNStepper_SetFullRhsFn(SUNStepper s, SUNStepperFullRhsFn f) {
  return store(s->full_rhs, f);
}
SUNErrCode SUNStepper_SetReInitFn(SUNStepper s, SUNStepperReInitFn f) {
  return store(s->reinit, f);
}
SUNErrCode SUNStepper_SetResetFn(SUNStepper s, SUNStepperResetFn f) {
  return store(s->reset, f);
}
SUNErrCode SUNStepper_SetStopTimeFn(SUNStepper s, SUNStepperSetStopTimeFn f) {
  return store(s->stop, f);
}
SUNErrCode SUNStepper_SetGetNumStepsFn(SUNStepper s, SUNStepperGetNumStepsFn f) {
  return store(s->steps, f);
}

SUNErrCode SUNStepper_Evolve(SUNStepper s, sunrealtype tout, N_Vector v, sunrealtype* tret) {
  return call(s->evolve, s, tout, v, tret);
}
SUNErrCode SUNStepper_OneStep(SUNStepper s, sunrealtype tout, N_Vector v, sunrealtype* tret) {
  return call(s->one_step, s, tout, v, tret);
}
SUNErrCode SUNStepper_FullRhs(SUNStepper s, sunrealtype t, N_Vector v, N_Vector f, SUNFullRhsMode mode) {
  return call(s->full_rhs, s, t, v, f, mode);
}
SUNErrCode SUNStepper_ReInit(SUNStepper s, sunrealtype t, N_Vector v) {
  return call(s->reinit, s, t, v);
}
SUNErrCode SUNStepper_Reset(SUNStepper s, sunrealtype t, N_Vector v) {
  return call(s->reset, s, t, v);
}
SUNErrCode SUNStepper_SetStopTime(SUNStepper s, sunrealtype tstop) {
  return call(s->stop, s, tstop);
}
SUNErrCode SUNStepper_GetNumSteps(SUNStepper s, suncountertype* steps) {
  return call(s->steps, s, steps);
}
