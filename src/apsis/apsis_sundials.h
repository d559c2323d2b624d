/// Apsis for programs that use SUNDIALS: time integration of u' = T(t, u) + Q(t, u), where u is any N_Vector.
///
/// The transport T is explicit and the collision Q implicit, as f_E and f_I of ARKODE. Callbacks have the
/// types of ARKODE. A name after a final colon, such as ARKStepReset, is the counterpart in SUNDIALS. Only
/// the operations of vectors access their data, and any SUNLinearSolver may solve linear systems. All
/// quantities are dimensionless. docs/sundials.md has an example.
///
/// Functions that return an int return one of apsis_status (apsis.h). Errors are negative;
/// apsis_error_message() describes the last error of the calling thread. There is no global state: threads
/// may use different integrators simultaneously. With several processes every process makes the same calls,
/// and callbacks return the same results.
#ifndef APSIS_APSIS_SUNDIALS_H
#define APSIS_APSIS_SUNDIALS_H

#include <apsis/apsis.h>

#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nvector.h>
#include <sundials/sundials_types.h>
#include <sundials/sundials_version.h>
#if SUNDIALS_VERSION_MAJOR > 7 || (SUNDIALS_VERSION_MAJOR == 7 && SUNDIALS_VERSION_MINOR >= 5)
#include <sundials/sundials_stepper.h>
/// Defined where SUNDIALS has steppers: version 7.5 and later.
#define APSIS_SUNDIALS_HAS_STEPPERS
#endif

/// Version of the binary interface, part of the name of the library file. It changes with every change that a
/// compiled program could notice; additions do not change it.
#define APSIS_SUNDIALS_ABI_VERSION 1

#ifdef __cplusplus
extern "C" {
#endif

// Callbacks -------------------------------------------------------------------------------------------------

/// Callbacks return 0 on success. A positive number rejects the state. Steps controlled by a tolerance are
/// then repeated with a smaller length; others end the integration with APSIS_NUMERICAL_ERROR. A negative
/// number ends it with APSIS_CALLBACK_ERROR. `data` is the pointer given to apsis_sundials_set_user_data().

/// ydot ← T(t, y) or Q(t, y): ARKRhsFn.
typedef int apsis_sundials_rate_function(sunrealtype t, N_Vector y, N_Vector ydot, void* data);
/// Prepares products with ∂Q/∂y at (t, y); fy = Q(t, y): ARKLsJacTimesSetupFn.
typedef int apsis_sundials_product_setup(sunrealtype t, N_Vector y, N_Vector fy, void* data);
/// jv ← ∂Q/∂y v at (t, y); `work` is scratch space: ARKLsJacTimesVecFn. Its error enters the solution of
/// methods with second derivatives, through Q̇ = Q'Q.
typedef int apsis_sundials_product_function(N_Vector v, N_Vector jv, sunrealtype t, N_Vector y, N_Vector fy,
                                            void* data, N_Vector work);
/// jacobian ← ∂Q/∂y at (t, y): ARKLsJacFn.
typedef int apsis_sundials_jacobian_function(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix jacobian,
                                             void* data, N_Vector work1, N_Vector work2, N_Vector work3);
/// Prepares a preconditioner P ≈ I − γ ∂Q/∂y at (t, y): ARKLsPrecSetupFn. With jok ≠ 0 it may use earlier
/// data of the Jacobian. It sets *jcur to 1 if it computed new data, otherwise to 0.
typedef int apsis_sundials_preconditioner_setup(sunrealtype t, N_Vector y, N_Vector fy, int jok, int* jcur,
                                                sunrealtype gamma, void* data);
/// Solves P z = r, with errors below `delta` if it iterates; lr is 1 for a left and 2 for a right
/// preconditioner: ARKLsPrecSolveFn.
typedef int apsis_sundials_preconditioner_solve(sunrealtype t, N_Vector y, N_Vector fy, N_Vector r,
                                                N_Vector z, sunrealtype gamma, sunrealtype delta, int lr,
                                                void* data);
/// y ← v, in place, with v = y + a Q(t, v) + b Q̇(t, v), Q̇ = Q'Q, a ≥ 0 and b ≤ 0, not both 0. If a relaxation
/// time is given, error estimates project to equilibrium by a = 1e100.
typedef int apsis_sundials_stage_function(sunrealtype t, sunrealtype a, sunrealtype b, N_Vector y,
                                          void* data);
/// *result ← a positive time: Δt_FE of T, or the smallest relaxation time of Q: ARKExpStabFn.
typedef int apsis_sundials_time_function(N_Vector y, sunrealtype t, sunrealtype* result, void* data);
/// g[k] ← g_k(t, y), the functions whose zeros are events: ARKRootFn.
typedef int apsis_sundials_root_function(sunrealtype t, N_Vector y, sunrealtype* g, void* data);
/// Observes y after a step of length dt that ended at t; `step` counts from 1 since the start. A positive
/// number ends the integration with APSIS_STOPPED. `y` must not be changed.
typedef int apsis_sundials_observer(long long step, sunrealtype t, sunrealtype dt, N_Vector y, void* data);

// Integrators -----------------------------------------------------------------------------------------------

/// A problem, a method, and a state that advances in time.
typedef struct apsis_sundials apsis_sundials;

/// Sets *created to a new integrator that starts at t0 with a copy of y0. apsis_sundials_free() must release
/// it before `context` is released and before MPI ends. transport or collision may be NULL, for T = 0 or Q =
/// 0. Errors: APSIS_INPUT_ERROR if an argument is NULL, if t0 or y0 is not finite, if y0 lacks an operation,
/// or if the method needs exact collisions; *created is then NULL.
int apsis_sundials_create(const apsis_method* method, apsis_sundials_rate_function* transport,
                          apsis_sundials_rate_function* collision, sunrealtype t0, N_Vector y0,
                          SUNContext context, apsis_sundials** created);
/// Releases an integrator. NULL is ignored.
void apsis_sundials_free(apsis_sundials* integrator);

/// Every setting may be changed between two calls of apsis_sundials_evolve(); NULL removes a callback.
/// Settings other than data and observers restart the control of step lengths. In callbacks, all settings,
/// apsis_sundials_reset() and apsis_sundials_evolve() return APSIS_INPUT_ERROR.

/// Sets the time and the state, which is copied, and resets all counters to 0: ARKStepReset.
int apsis_sundials_reset(apsis_sundials* integrator, sunrealtype t, N_Vector y);
/// Sets the last argument of all callbacks, initially NULL.
int apsis_sundials_set_user_data(apsis_sundials* integrator, void* data);

/// Newton's method solves the stages v = u + a Q(t, v) + b Q̇(t, v), unless the program solves them:
/// apsis_sundials_set_stage(). Newton's systems have the matrix I − aJ − bJ², J = ∂Q/∂y.

/// Sets the solver of stages, which replaces Newton's method.
int apsis_sundials_set_stage(apsis_sundials* integrator, apsis_sundials_stage_function* stage);
/// Sets the linear solver, which the integrator does not own. It is iterative without a matrix, or direct
/// with a matrix that supports products with vectors and c A + I. A direct solver factorizes I − γJ, γ =
/// √|b|, to precondition GMRES from both sides. For methods without second derivatives (b = 0, γ = a) it
/// solves the systems alone. By default GMRES solves them, which needs the operation nvdiv. Error:
/// APSIS_INPUT_ERROR for other pairs.
int apsis_sundials_set_linear_solver(apsis_sundials* integrator, SUNLinearSolver solver, SUNMatrix matrix);
/// Sets products with the Jacobian, and the function that prepares them, or NULL. Without products and
/// matrix, central differences of Q replace them: ARKStepSetJacTimes.
int apsis_sundials_set_products(apsis_sundials* integrator, apsis_sundials_product_setup* setup,
                                apsis_sundials_product_function* product);
/// Sets the Jacobian as a matrix, which a direct solver needs: ARKStepSetJacFn.
int apsis_sundials_set_jacobian(apsis_sundials* integrator, apsis_sundials_jacobian_function* jacobian);
/// Sets the preconditioner P ≈ I − γJ of an iterative solver, and the function that prepares it, or NULL. It
/// is applied once if b = 0, with γ = a, and twice otherwise, with γ = √|b|. The solver preconditions from
/// one side: ARKStepSetPreconditioner.
int apsis_sundials_set_preconditioner(apsis_sundials* integrator, apsis_sundials_preconditioner_setup* setup,
                                      apsis_sundials_preconditioner_solve* solve);

/// Steps have the length dt, or satisfy Δt ≤ safety · r · Δt_FE; a tolerance shortens them further where
/// the estimated error requires it. At least one of dt, Δt_FE and a tolerance must be given, but not both
/// dt and Δt_FE.

/// Sets the length of steps; it is reduced until it divides the interval of apsis_sundials_evolve(). With a
/// tolerance it is the largest length. 0 removes it: ARKStepSetFixedStep, ARKStepSetMaxStep.
int apsis_sundials_set_step(apsis_sundials* integrator, sunrealtype dt);
/// Sets the longest first step after the start, with a tolerance. 0 removes it: ARKStepSetInitStep.
int apsis_sundials_set_first_step(apsis_sundials* integrator, sunrealtype dt);
/// Sets Δt_FE of T for the property to be preserved. The method must have an SSP coefficient:
/// ARKStepSetStabilityFn.
int apsis_sundials_set_forward_euler_step(apsis_sundials* integrator, apsis_sundials_time_function* step);
/// Sets the factor of r Δt_FE, initially 1.
int apsis_sundials_set_safety(apsis_sundials* integrator, sunrealtype safety);
/// Controls the estimated error e of a step in the norm of ARKODE, √(Σ (e_i w_i)²/n) ≤ 1 with
/// w_i = 1/(relative |y_i| + absolute). relative ≥ 0, and absolute > 0; both 0 removes the control:
/// ARKStepSStolerances.
int apsis_sundials_set_tolerance(apsis_sundials* integrator, sunrealtype relative, sunrealtype absolute);
/// Does the same with an absolute tolerance for each unknown, positive numbers that are
/// copied: ARKStepSVtolerances. Error: APSIS_INPUT_ERROR for other numbers, and without the operation nvmin.
int apsis_sundials_set_tolerances(apsis_sundials* integrator, sunrealtype relative, N_Vector absolute);
/// Sets the law of step control, as apsis_set_controller(): ARKStepSetAdaptivityMethod.
int apsis_sundials_set_controller(apsis_sundials* integrator, const char* name);
/// Requires y_i ≥ 0, > 0, ≤ 0 or < 0 where the constraint is 1, 2, −1 or −2, and nothing where it is 0, as
/// ARKODE does. The vector is copied; NULL removes it. Newton's method does not leave these states. A stage
/// outside them ends the step with an error; a step to a tolerance is shortened until its stages and its
/// result satisfy them: ARKStepSetConstraints. Error: APSIS_INPUT_ERROR for other numbers, and without the
/// operation nvconstrmask.
int apsis_sundials_set_constraints(apsis_sundials* integrator, N_Vector constraints);
/// Sets the relaxation time of a collision with a stage solver. Error estimates then give less weight to
/// deviations from equilibrium that relax within a step.
int apsis_sundials_set_relaxation_time(apsis_sundials* integrator, apsis_sundials_time_function* time);
/// Divides the first step after the start into graded steps that resolve the initial layer, for data out of
/// equilibrium (docs/plateaus.md). `growth`, from 2 to 64, is the ratio of their successive times; 0 removes
/// the graded steps. A relaxation time is required.
int apsis_sundials_set_graded_start(apsis_sundials* integrator, int growth);

/// Sets the function that observes every step.
int apsis_sundials_set_observer(apsis_sundials* integrator, apsis_sundials_observer* observer);
/// Sets `count` functions whose zeros are events, as apsis_set_events(): `directions` are 1 for increasing
/// g_k, −1 for decreasing, and 0 for both; NULL means both for all. `ends` are 1 if an event ends the
/// integration with APSIS_EVENT, otherwise 0; NULL means that all do. Both lists are copied. count = 0
/// removes the events: ARKStepRootInit, ARKStepSetRootDirection.
int apsis_sundials_set_events(apsis_sundials* integrator, size_t count, apsis_sundials_root_function* roots,
                              const int* directions, const int* ends);
/// Sets times at which steps end exactly: `count` increasing numbers, which are copied. count = 0 removes
/// them: ARKStepSetStopTime.
int apsis_sundials_set_stop_times(apsis_sundials* integrator, size_t count, const sunrealtype* times);

/// Integrates from the time reached to tout and ends exactly there. Copies the time and the state to
/// *treached and y, which may be NULL. After an error these are those of the last accepted step. Returns
/// APSIS_OK, APSIS_STOPPED, APSIS_EVENT or an error: ARKStepEvolve with ARK_NORMAL.
int apsis_sundials_evolve(apsis_sundials* integrator, sunrealtype tout, N_Vector y, sunrealtype* treached);
/// Does the same for one step, the first of those to tout: ARKStepEvolve with ARK_ONE_STEP. The observer
/// sees it.
int apsis_sundials_one_step(apsis_sundials* integrator, sunrealtype tout, N_Vector y, sunrealtype* treached);
/// Returns the time reached; NaN for NULL.
sunrealtype apsis_sundials_time(const apsis_sundials* integrator);
/// Writes the solution at a time of the last step to y, as apsis_state_at() does. It has the order and the
/// positivity of the method: ARKStepGetDky with k = 0.
int apsis_sundials_state_at(apsis_sundials* integrator, sunrealtype t, N_Vector y);
/// Sets *k and *t to the function and the time of an event; `index` counts events from 0 in the order of
/// time. Error: APSIS_INPUT_ERROR unless index < apsis_sundials_count(integrator, APSIS_SUNDIALS_EVENTS).
int apsis_sundials_found_event(const apsis_sundials* integrator, size_t index, size_t* k, sunrealtype* t);

/// Counters since the start.
enum apsis_sundials_counter {
  APSIS_SUNDIALS_STEPS = 0,           ///< accepted steps
  APSIS_SUNDIALS_REJECTED_STEPS = 1,  ///< steps repeated because of their error, or because they failed
  APSIS_SUNDIALS_TRANSPORT_EVALUATIONS = 2,  ///< calls of T
  APSIS_SUNDIALS_COLLISION_EVALUATIONS = 3,  ///< calls of Q, including those for differences
  APSIS_SUNDIALS_STAGE_SOLVES = 4,           ///< stages, solved by Newton's method or by the program
  APSIS_SUNDIALS_NEWTON_ITERATIONS = 5,      ///< linear systems of Newton's method
  APSIS_SUNDIALS_LINEAR_ITERATIONS = 6,      ///< iterations of the linear solver
  APSIS_SUNDIALS_PRODUCTS = 7,               ///< calls of products with the Jacobian
  APSIS_SUNDIALS_JACOBIANS = 8,              ///< calls of the Jacobian matrix
  APSIS_SUNDIALS_PRECONDITIONER_SETUPS = 9,  ///< calls of what prepares the preconditioner, or factorizations
  APSIS_SUNDIALS_PRECONDITIONER_SOLVES = 10,  ///< calls of the preconditioner
  APSIS_SUNDIALS_EVENTS = 11                  ///< events
};
/// Returns a counter, one of apsis_sundials_counter; −1 for NULL and for an unknown counter.
long long apsis_sundials_count(const apsis_sundials* integrator, int counter);

#ifdef APSIS_SUNDIALS_HAS_STEPPERS
/// Sets *stepper to a SUNStepper that evolves, steps, resets and stops the integrator, and evaluates T + Q,
/// as other integrators of SUNDIALS combine them. It does not integrate backward, and has no forcing.
/// SUNStepper_Destroy() releases it, before the integrator. Its last flag is an apsis_status.
/// SUNStepper_Reset() does not reset its number of steps, SUNStepper_ReInit() does.
int apsis_sundials_make_stepper(apsis_sundials* integrator, SUNStepper* stepper);
#endif

/// Returns a copy of y whose scalar products and norms are exact sums, rounded once. They do not depend on
/// how the vector is divided among threads or processes. N_VDestroy() releases the copy. A linear solver made
/// from it, such as SUNLinSol_SPGMR(copy, …), has the same bits on any number of processes; so has the
/// default linear solver. Returns NULL if memory or an operation is missing.
N_Vector apsis_sundials_clone(N_Vector y);

#ifdef __cplusplus
}
#endif

#endif
