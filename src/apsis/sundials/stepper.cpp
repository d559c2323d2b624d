// Compiled if SUNDIALS has steppers (version 7.5 and later). Other integrators of SUNDIALS can combine them.
#include "internal/integrator_handle.hpp"

#include <apsis/c/internal/guarded.hpp>
#include <apsis/core/errors.hpp>

#include <string>
#include <utility>

#ifdef APSIS_SUNDIALS_HAS_STEPPERS

namespace apsis::sundials {
namespace {

apsis_sundials* content_of(SUNStepper stepper) {
  void* content = nullptr;
  SUNStepper_GetContent(stepper, &content);
  return static_cast<apsis_sundials*>(content);
}

/// Stores the apsis_status as the last flag of the stepper. Returns success or failure.
SUNErrCode outcome(SUNStepper stepper, int status) {
  SUNStepper_SetLastFlag(stepper, status);
  return status >= 0 ? SUN_SUCCESS : SUN_ERR_EXT_FAIL;
}

SUNErrCode evolve(SUNStepper stepper, sunrealtype tout, N_Vector y, sunrealtype* t) {
  return outcome(stepper, apsis_sundials_evolve(content_of(stepper), tout, y, t));
}

SUNErrCode one_step(SUNStepper stepper, sunrealtype tout, N_Vector y, sunrealtype* t) {
  return outcome(stepper, apsis_sundials_one_step(content_of(stepper), tout, y, t));
}

/// f ← T + Q.
SUNErrCode full_rate(SUNStepper stepper, sunrealtype t, N_Vector y, N_Vector f, SUNFullRhsMode) {
  return outcome(stepper, c::guarded([=] {
                   apsis_sundials& s = *content_of(stepper);
                   s.of.evaluate_transport(t, y, f);
                   nvector rate = s.u.another();
                   s.of.evaluate_collision(t, y, rate.get());
                   N_VLinearSum(1.0, f, 1.0, rate.get(), f);
                   return APSIS_OK;
                 }));
}

SUNErrCode reinitialize(SUNStepper stepper, sunrealtype t, N_Vector y) {
  return outcome(stepper, apsis_sundials_reset(content_of(stepper), t, y));
}

/// Unlike reinitialize(), does not set the number of steps to 0.
SUNErrCode reset(SUNStepper stepper, sunrealtype t, N_Vector y) {
  apsis_sundials* s = content_of(stepper);
  const long long before = s->steps_before_reset + apsis_sundials_count(s, APSIS_SUNDIALS_STEPS);
  const int status = apsis_sundials_reset(s, t, y);
  if (status == APSIS_OK) s->steps_before_reset = before;
  return outcome(stepper, status);
}

SUNErrCode set_stop_time(SUNStepper stepper, sunrealtype t) {
  return outcome(stepper, apsis_sundials_set_stop_times(content_of(stepper), 1, &t));
}

SUNErrCode get_steps(SUNStepper stepper, suncountertype* steps) {
  const apsis_sundials* s = content_of(stepper);
  *steps = static_cast<suncountertype>(s->steps_before_reset + apsis_sundials_count(s, APSIS_SUNDIALS_STEPS));
  return SUN_SUCCESS;
}

void require_success(SUNErrCode returned) {
  if (returned != SUN_SUCCESS)
    throw input_error("SUNDIALS does not make a stepper (it returned " + std::to_string(returned) +
                      "); check its context");
}

/// Destroys a stepper that is not released.
class owned_stepper {
 public:
  explicit owned_stepper(SUNContext context) { require_success(SUNStepper_Create(context, &stepper_)); }
  ~owned_stepper() {
    if (stepper_ != nullptr) SUNStepper_Destroy(&stepper_);
  }
  owned_stepper(const owned_stepper&) = delete;
  owned_stepper& operator=(const owned_stepper&) = delete;
  SUNStepper get() const { return stepper_; }
  SUNStepper release() { return std::exchange(stepper_, nullptr); }

 private:
  SUNStepper stepper_ = nullptr;
};

}  // namespace
}  // namespace apsis::sundials

int apsis_sundials_make_stepper(apsis_sundials* integrator, SUNStepper* stepper) {
  using namespace apsis::sundials;
  return apsis::c::guarded([=] {
    apsis::c::require(stepper, "the place of the stepper") = nullptr;
    owned_stepper owned(idle(integrator).of.context);
    SUNStepper made = owned.get();
    for (const SUNErrCode returned :
         {SUNStepper_SetContent(made, integrator), SUNStepper_SetEvolveFn(made, evolve),
          SUNStepper_SetOneStepFn(made, one_step), SUNStepper_SetFullRhsFn(made, full_rate),
          SUNStepper_SetReInitFn(made, reinitialize), SUNStepper_SetResetFn(made, reset),
          SUNStepper_SetStopTimeFn(made, set_stop_time), SUNStepper_SetGetNumStepsFn(made, get_steps)})
      require_success(returned);
    *stepper = owned.release();
    return APSIS_OK;
  });
}

#endif
