/// The C interface of Apsis: methods, and time integration of u' = T(t, u) + Q(u) over arrays of doubles.
///
/// The transport T is explicit; the collision Q is stiff and implicit. It may depend on t if it has a rate
/// (apsis_set_timed_rate()). All quantities are dimensionless. docs/linking.md has an example, and states
/// what later versions preserve.
///
/// Functions that return an int return one of apsis_status unless they are described otherwise, and never end
/// the program. Errors are negative; apsis_error_message() describes the last error of the calling thread.
/// There is no global state: threads may use different handles simultaneously. They may share a method, but
/// not an integrator.
#ifndef APSIS_APSIS_H
#define APSIS_APSIS_H

#include <stddef.h>

/// Version of the binary interface, part of the name of the library file. It changes with every change that a
/// compiled program could notice; additions do not change it.
#define APSIS_ABI_VERSION 1

#ifdef __cplusplus
extern "C" {
#endif

/// Results of functions. Errors are negative.
enum apsis_status {
  APSIS_OK = 0,                ///< success; apsis_integrate() has reached the requested time
  APSIS_STOPPED = 1,           ///< the observer ended the integration
  APSIS_EVENT = 2,             ///< an event ended the integration
  APSIS_INPUT_ERROR = -1,      ///< an invalid argument, name, file or combination of settings
  APSIS_NUMERICAL_ERROR = -2,  ///< a step failed: NaN, no convergence, a state that a callback rejects
  APSIS_FILE_ERROR = -3,       ///< a file cannot be read
  APSIS_CLAIM_ERROR = -4,      ///< a method does not have the properties that its file claims
  APSIS_CALLBACK_ERROR = -5,   ///< a callback returned a negative number
  APSIS_MEMORY_ERROR = -6,     ///< memory is exhausted
  APSIS_INTERNAL_ERROR = -7    ///< an error of Apsis itself
};

/// Returns the APSIS_ABI_VERSION of the library, to be compared with that of the header.
int apsis_abi_version(void);
/// Returns the version of the library, "1.2.3".
const char* apsis_version(void);
/// Returns the message of the last error of this thread, "problem (reason); suggestion."; "" before the
/// first. Valid until the next error of this thread.
const char* apsis_error_message(void);
/// Stores the message of an error as the last one of this thread and returns `status`: for libraries that
/// extend this interface.
int apsis_store_error(int status, const char* message);

// Methods ---------------------------------------------------------------------------------------------------

/// A certified time integrator. Functions of methods are thread-safe, even on the same method.
typedef struct apsis_method apsis_method;

/// Returns the number of methods of the catalogue. Members of families, such as "md-imex-chain-5-2", are
/// found by name and not counted.
size_t apsis_catalogue_size(void);
/// Returns the name of a method of the catalogue, index from 0; NULL beyond the last. Valid to the end of the
/// program.
const char* apsis_catalogue_name(size_t index);

/// Sets *method to the method called `name`: a method of the catalogue, a member of a family, a formula such
/// as "imex-bdf-3", or a method file given by its path, FILE.toml. docs/methods.md and `apsis list choices`
/// recommend methods. apsis_free_method() releases it. Methods are certified when they are loaded. Errors:
/// APSIS_INPUT_ERROR with the nearest name, APSIS_FILE_ERROR, or APSIS_CLAIM_ERROR if a claim of a file does
/// not hold; *method is then NULL.
int apsis_find_method(const char* name, apsis_method** method);
/// Releases a method; integrators made from it remain valid. NULL is ignored.
void apsis_free_method(apsis_method* method);

/// Returns the name of a method; "" for NULL. Valid as long as the method.
const char* apsis_method_name(const apsis_method* method);
/// Returns the title of a method, one line; "" for NULL. Valid as long as the method.
const char* apsis_method_title(const apsis_method* method);
/// Returns the kind of a method, "runge-kutta", "exponential", "two-step", "imex-bdf" or "imex-dimsim";
/// "" for NULL.
const char* apsis_method_kind(const apsis_method* method);
/// Returns the order p of a method; 0 for NULL.
int apsis_method_order(const apsis_method* method);
/// Returns the number k of steps of a method: u^{n+1} depends on u^{n+1−k}, …, u^n; 0 for NULL.
int apsis_method_steps(const apsis_method* method);
/// Returns the number s of stages of a method; 0 for NULL.
size_t apsis_method_stages(const apsis_method* method);
/// Returns the SSP coefficient r of a method: steps Δt ≤ r Δt_FE preserve what forward Euler steps of T
/// preserve. 0 if there is no such step, and for NULL.
double apsis_method_ssp_coefficient(const apsis_method* method);

/// Requirements of a method.
enum apsis_needs {
  APSIS_NEEDS_RATE = 1,        ///< evaluates Q(u): apsis_set_rate()
  APSIS_NEEDS_FLOW = 2,        ///< solves u' = Q(u) exactly: apsis_set_flow()
  APSIS_NEEDS_EQUAL_STEPS = 4  ///< steps have equal lengths: apsis_set_step(), without a tolerance
};
/// Returns the sum of the apsis_needs of a method; 0 for NULL.
int apsis_method_needs(const apsis_method* method);

/// Coefficients of a method with s stages. Matrices are s × s, row by row; for the equations of both forms
/// see docs/methods.md.
enum apsis_coefficients {
  APSIS_SHU_OSHER_P = 0,     ///< p_ij, s × s
  APSIS_SHU_OSHER_W = 1,     ///< w_ij, s × s
  APSIS_SHU_OSHER_D = 2,     ///< d_ij, s × s
  APSIS_SHU_OSHER_DDOT = 3,  ///< ḋ_i, s numbers ≤ 0
  APSIS_SHU_OSHER_R = 4,     ///< r, one number
  APSIS_BUTCHER_A_HAT = 5,   ///< â_ij of T, s × s
  APSIS_BUTCHER_A = 6,       ///< a_ij of Q, s × s
  APSIS_BUTCHER_A_DOT = 7    ///< ȧ_ij of Q̇, s × s
};
/// Writes the coefficients `which`, one of apsis_coefficients, to `values`, correctly rounded. Those of the
/// Butcher form are computed with 60 digits. Error: APSIS_INPUT_ERROR for a formula (kinds "imex-bdf" and
/// "imex-dimsim"), and for the Butcher form of a method of two steps.
int apsis_method_coefficients(const apsis_method* method, int which, double* values);
/// Sets *text to the method file with exact coefficients. Valid as long as the method. Error:
/// APSIS_INPUT_ERROR for a formula and for a method of two steps.
int apsis_method_file(const apsis_method* method, const char** text);
/// Sets *text to the certificate, properties derived from the coefficients alone: lines "key = value". Valid
/// as long as the method.
int apsis_method_certificate(const apsis_method* method, const char** text);
/// Sets *value to a number of the certificate, whose text has the keys; flags are 0 or 1. Error:
/// APSIS_INPUT_ERROR with the nearest key, or if the value is a text.
int apsis_method_fact(const apsis_method* method, const char* key, double* value);

// Callbacks -------------------------------------------------------------------------------------------------

/// Callbacks return 0 on success. A positive number rejects the state, as if it were NaN. Steps controlled by
/// a tolerance are then repeated with a smaller length; others end the integration with
/// APSIS_NUMERICAL_ERROR. A negative number ends it with APSIS_CALLBACK_ERROR. `data` is the pointer given to
/// apsis_set_data(), and `n` the number of unknowns in `u`. Outputs have undefined contents before the
/// call; callbacks set every entry, also those that are 0.

/// out ← T(t, u).
typedef int apsis_transport_function(double t, size_t n, const double* u, double* out, void* data);
/// u ← v, in place, with v = u + a Q(v) + b Q̇(v), Q̇ = Q'Q, a ≥ 0 and b ≤ 0, not both 0; `t` is the time of
/// the stage. Methods without derivatives have b = 0. If a relaxation time is given, error estimates project
/// to equilibrium by a = 1e100.
typedef int apsis_stage_function(double t, double a, double b, size_t n, double* u, void* data);
/// u ← exp(sQ) u, in place: the solution of u' = Q(u) after a time s ≥ 0.
typedef int apsis_flow_function(double t, double s, size_t n, double* u, void* data);
/// q ← Q(u) for one block (apsis_set_block_size), numbered from 0.
typedef int apsis_rate_function(size_t block, size_t n, const double* u, double* q, void* data);
/// q ← Q(t, u) for one block.
typedef int apsis_timed_rate_function(double t, size_t block, size_t n, const double* u, double* q,
                                      void* data);
/// jacobian[i n + j] ← ∂Q_i/∂u_j (u) for one block: n × n numbers, row by row, i and j from 0.
typedef int apsis_jacobian_function(size_t block, size_t n, const double* u, double* jacobian, void* data);
/// jx ← Q'(u) x for one block. Its error enters the solution through Q̇ = Q'Q.
typedef int apsis_product_function(size_t block, size_t n, const double* u, const double* x, double* jx,
                                   void* data);
/// jx ← ∂Q/∂u (t, u) x for one block.
typedef int apsis_timed_product_function(double t, size_t block, size_t n, const double* u, const double* x,
                                         double* jx, void* data);
/// hx ← Q''(u)[k, x] for one block. Its error only slows Newton's method.
typedef int apsis_curvature_function(size_t block, size_t n, const double* u, const double* k,
                                     const double* x, double* hx, void* data);
/// Prepares solves of (M − γ Q'(t, u)) x = r for one block, γ > 0, for example by a factorization of an
/// approximate matrix. M is the mass matrix, or 1.
typedef int apsis_prepare_function(double t, double gamma, size_t block, size_t n, const double* u,
                                   void* data);
/// x ← an approximate solution of (M − γ Q'(t, u)) x = r for one block. t, γ, the block and u are those of
/// the last call of apsis_prepare_function.
typedef int apsis_precondition_function(double t, double gamma, size_t block, size_t n, const double* u,
                                        const double* r, double* x, void* data);
/// *result ← a positive time: Δt_FE, or the smallest relaxation time ε/C of the state.
typedef int apsis_time_function(double t, size_t n, const double* u, double* result, void* data);
/// *result ← 1 if the block u is admissible (for example positive), otherwise 0. An inadmissible stage ends
/// the step with an error. A step to a tolerance is shortened until its stages and its result are admissible.
typedef int apsis_admissible_function(size_t block, size_t n, const double* u, int* result, void* data);
/// Observes u after a step of length dt that ended at t; `step` counts from 1 since apsis_start(). A positive
/// number ends the integration with APSIS_STOPPED.
typedef int apsis_observer_function(long long step, double t, double dt, size_t n, const double* u,
                                    void* data);

/// g[k] ← g_k(t, u) for k = 0 … count − 1, the functions whose zeros are events.
typedef int apsis_event_function(double t, size_t n, const double* u, size_t count, double* g, void* data);
/// Observes an event of function k, just after the sign of g_k has changed.
typedef int apsis_event_observer_function(size_t k, double t, size_t n, const double* u, void* data);

// Integrators -----------------------------------------------------------------------------------------------

/// A problem, a method, and a state that advances in time.
typedef struct apsis_integrator apsis_integrator;

/// Sets *integrator to a new integrator for n unknowns; apsis_free_integrator() releases it. Error:
/// APSIS_INPUT_ERROR for n = 0; *integrator is then NULL.
int apsis_new_integrator(const apsis_method* method, size_t n, apsis_integrator** integrator);
/// Releases an integrator. NULL is ignored.
void apsis_free_integrator(apsis_integrator* integrator);

/// Every setting may be changed between two calls of apsis_integrate(), which checks their combination; NULL
/// removes a callback. Settings other than data and observers restart the control of step lengths. In
/// callbacks, all settings, apsis_start() and apsis_integrate() return APSIS_INPUT_ERROR.

/// Sets the last argument of all callbacks, initially NULL.
int apsis_set_data(apsis_integrator* integrator, void* data);
/// Sets T. Without it T = 0.
int apsis_set_transport(apsis_integrator* integrator, apsis_transport_function* transport);

/// The collision is given in one of two ways: by a solver of its stages (apsis_set_stage()), or by its rate
/// (apsis_set_rate()). Newton's method solves the stages if there is no solver. Its derivatives of Q come
/// from apsis_set_jacobian() or apsis_set_product(). Without a collision, Q = 0.
///
/// Without derivatives of Q, central differences of the rate replace them, with about ten digits. A matrix
/// takes two calls of the rate for each unknown of a block, or for each group of columns of a sparsity
/// pattern. Unknowns change by 6e-6 max(|u_i|, 1e-6 max_j |u_j|), so that they may leave the admissible set.
/// A rate that is not defined there has no derivative. Errors of differences enter Q̇ = Q'Q. If Q is much
/// faster than a step, choose a method without second derivatives, such as "extrapolated-euler-5".

/// Sets the solver of stages.
int apsis_set_stage(apsis_integrator* integrator, apsis_stage_function* stage);
/// Sets Q, which Newton's method and methods with APSIS_NEEDS_RATE evaluate.
int apsis_set_rate(apsis_integrator* integrator, apsis_rate_function* rate);
/// Sets Q(t, u) instead of Q(u). Methods without T that use Q̇ then need ∂Q/∂t, which differences of Q compute
/// over 1e-5 of the step. Its derivatives are apsis_set_timed_product(), or differences.
int apsis_set_timed_rate(apsis_integrator* integrator, apsis_timed_rate_function* rate);
/// Sets products with the Jacobian of Q(t, u). Without them, differences of Q(t, u) replace them.
int apsis_set_timed_product(apsis_integrator* integrator, apsis_timed_product_function* product);
/// Sets the Jacobian of Q as a matrix. Without it and without products, differences of Q replace it.
int apsis_set_jacobian(apsis_integrator* integrator, apsis_jacobian_function* jacobian);
/// Sets products with the Jacobian of Q, which are used in preference to the matrix.
int apsis_set_product(apsis_integrator* integrator, apsis_product_function* product);
/// Sets the second derivative of Q. Without it, differences replace it.
int apsis_set_curvature(apsis_integrator* integrator, apsis_curvature_function* curvature);
/// Sets the exact solution of the collision, for methods of kind "exponential".
int apsis_set_flow(apsis_integrator* integrator, apsis_flow_function* flow);
/// Sets the number of consecutive unknowns that Q couples, initially n: u is a sequence of such blocks, for
/// example the cells of a mesh. The rate, its derivatives and `admissible` receive one block. Error:
/// APSIS_INPUT_ERROR unless the size divides n.
int apsis_set_block_size(apsis_integrator* integrator, size_t size);
/// Sets the largest block, initially 96 unknowns, whose linear systems in Newton's method are dense. GMRES
/// without a preconditioner solves larger ones, which is only suitable if Q is not stiff. For larger stiff
/// blocks give a sparsity pattern, a preconditioner, or a larger limit.
int apsis_set_dense_limit(apsis_integrator* integrator, size_t unknowns);
/// Sets the places of the Jacobian of a block that may be nonzero: `count` rows and columns, counted from 0,
/// which are copied. Places on the diagonal always belong to them. Stages are then solved by sparse
/// factorizations, and products compute the entries of several columns at a time. A Jacobian callback still
/// has n × n entries; products or differences suit a large block. Set the pattern after the block size; count
/// = 0 removes it. Error: APSIS_INPUT_ERROR for a place outside of the block.
int apsis_set_sparsity(apsis_integrator* integrator, size_t count, const size_t* rows, const size_t* columns);
/// Sets a preconditioner: GMRES then solves the linear systems of Newton's method, for any number of
/// unknowns. Stages without Q̇ have γ = a. Those with Q̇ have γ = √−b, and apply the solver twice. `prepare`
/// may be NULL. It is called before `solve` for each γ of a step and block, again after a solve for another γ
/// or block, and where GMRES does not converge. A step of a method with one γ on one block thus takes one
/// call. Several blocks without a tolerance take one in each stage. solve = NULL removes both. It cannot be
/// combined with a sparsity pattern or a stage solver.
int apsis_set_preconditioner(apsis_integrator* integrator, apsis_prepare_function* prepare,
                             apsis_precondition_function* solve);
/// Makes the system M u' = T(t, u) + Q(t, u), where the constant, invertible matrix M couples the unknowns of
/// a block and is the same for all blocks: `count` entries with rows and columns counted from 0, which are
/// copied; values at one place are added. Δt_FE is then that of u' = M⁻¹ T. It cannot be combined with a
/// stage solver or a flow. Set it after the block size; count = 0 removes it. Error: APSIS_INPUT_ERROR for a
/// place outside of the block, a number that is not finite, or a singular matrix.
int apsis_set_mass(apsis_integrator* integrator, size_t count, const size_t* rows, const size_t* columns,
                   const double* values);
/// Sets the condition that every stage must satisfy. Newton's method does not leave the admissible states.
int apsis_set_admissible(apsis_integrator* integrator, apsis_admissible_function* admissible);
/// Sets the relaxation time of a collision with a stage solver. Error estimates then give less weight to
/// deviations from equilibrium that relax within a step.
int apsis_set_relaxation_time(apsis_integrator* integrator, apsis_time_function* relaxation_time);

/// Steps have the length dt, or satisfy Δt ≤ safety · r · Δt_FE; a tolerance shortens them further where
/// the estimated error requires it. At least one of dt, Δt_FE and a tolerance must be given, but not both
/// dt and Δt_FE.

/// Sets the length of steps; it is reduced until it divides the interval of apsis_integrate(). With a
/// tolerance it is the largest length. 0 removes it.
int apsis_set_step(apsis_integrator* integrator, double dt);
/// Sets the length of the first step after apsis_start(), with a tolerance. The step is shorter where the
/// estimated error, another limit or the end of the interval requires it. 0 removes it; the problem then
/// determines the first step. It cannot be combined with a graded start.
int apsis_set_first_step(apsis_integrator* integrator, double dt);
/// Sets Δt_FE of T for the property to be preserved. The method must have an SSP coefficient.
int apsis_set_forward_euler_step(apsis_integrator* integrator, apsis_time_function* step);
/// Sets the factor of r Δt_FE, initially 1.
int apsis_set_safety(apsis_integrator* integrator, double safety);
/// Controls the estimated error e of a step: |e_i| ≤ absolute + relative |u_i| for every i. relative ≥ 0, and
/// absolute > 0; both 0 removes the control. Methods without an embedded solution take each step twice, as
/// one step and as two halves. Newton's method ends when its error is a thousandth of this bound.
/// Stages of methods without second derivatives then share one derivative of Q per step and block. If those
/// of several blocks have more than 2^24 entries, stages are solved to rounding errors instead.
int apsis_set_tolerance(apsis_integrator* integrator, double relative, double absolute);
/// Does the same with an absolute tolerance for each unknown: n positive numbers, which are copied.
int apsis_set_tolerances(apsis_integrator* integrator, double relative, const double* absolute);
/// Sets the law of step control, which determines the next step from the errors of the last ones. `name` is
/// one of `apsis list controllers`, such as "pi" or "pid", initially "predictive". Error: APSIS_INPUT_ERROR
/// with the nearest name.
int apsis_set_controller(apsis_integrator* integrator, const char* name);
/// Divides the first step after apsis_start() into graded steps that resolve the initial layer, for data out
/// of equilibrium (docs/plateaus.md). `growth`, from 2 to 64, is the ratio of their successive times; 0
/// removes the graded steps. With a tolerance, they limit the length of the first step instead. A relaxation
/// time is required.
int apsis_set_graded_start(apsis_integrator* integrator, int growth);
/// Sets the function that observes every step.
int apsis_set_observer(apsis_integrator* integrator, apsis_observer_function* observer);

/// Sets `count` functions whose zeros are events. An event is a change of sign from one step to the next,
/// located to rounding in the dense output of apsis_state_at(). A function that is 0 at the start has no
/// event until it has another sign. Two zeros inside one step are missed. `directions` are 1 for increasing
/// g_k, −1 for decreasing, and 0 for both; NULL means both for all. `ends` are 1 if an event of g_k ends the
/// integration with APSIS_EVENT, otherwise 0; NULL means that all do. Both lists are copied. count = 0
/// removes the events.
int apsis_set_events(apsis_integrator* integrator, size_t count, apsis_event_function* events,
                     const int* directions, const int* ends);
/// Sets the function that observes events in the order of time, before the observer of the step.
int apsis_set_event_observer(apsis_integrator* integrator, apsis_event_observer_function* observer);
/// Sets times at which steps end exactly, such as discontinuities of T: `count` increasing numbers, which are
/// copied. Methods that need equal steps restart at each. count = 0 removes them.
int apsis_set_stop_times(apsis_integrator* integrator, size_t count, const double* times);

/// Sets the time and the state, n numbers that are copied, and resets all counters to 0. Error:
/// APSIS_INPUT_ERROR if a number is not finite.
int apsis_start(apsis_integrator* integrator, double t0, const double* u0);
/// Integrates from the time reached to a finite t1, not before it, and ends exactly there. An event or the
/// observer may end it earlier. After an error the state is that of the last accepted step. In each of these
/// cases another call continues the integration, also with other settings. The number of steps has no limit;
/// an observer can set one. Methods that need equal steps begin each call with their starter. Returns
/// APSIS_OK, APSIS_STOPPED, APSIS_EVENT or an error.
int apsis_integrate(apsis_integrator* integrator, double t1);

/// Returns the time reached; NaN for NULL and before apsis_start().
double apsis_time(const apsis_integrator* integrator);
/// Returns the n numbers of the state; NULL without an integrator and before apsis_start(). Valid until the
/// next setting, or the next call of apsis_start(), apsis_integrate() or apsis_free_integrator().
const double* apsis_state(const apsis_integrator* integrator);

/// Writes the n numbers of the solution at a time t of the last step to `u`: dense output, also for
/// observers in the thread that runs them. It takes a step from the beginning of the last step to t, and
/// costs as much as a step. The result therefore has the order of the method, its positivity, its bounds and
/// its limit ε → 0. Methods that need equal steps use their starter. After a change of settings only t =
/// apsis_time() is valid. Errors: APSIS_INPUT_ERROR for other times, and those of a step.
int apsis_state_at(apsis_integrator* integrator, double t, double* u);
/// Sets *k and *t to the function and the time of an event since apsis_start(); `index` counts events from 0
/// in the order of time. Error: APSIS_INPUT_ERROR unless index < apsis_count(integrator, APSIS_EVENTS).
int apsis_found_event(const apsis_integrator* integrator, size_t index, size_t* k, double* t);

/// Counters since apsis_start().
enum apsis_counter {
  APSIS_STEPS = 0,           ///< accepted steps
  APSIS_REJECTED_STEPS = 1,  ///< steps repeated because of their estimated error, or because they failed
  APSIS_TRANSPORT_EVALUATIONS = 2,  ///< calls of the transport
  APSIS_STAGE_SOLVES = 3,           ///< calls of the stage solver, or of Newton's method for a block
  APSIS_NEWTON_ITERATIONS = 4,      ///< linear systems of Newton's method
  APSIS_RATE_EVALUATIONS = 5,       ///< calls of the rate, including those for differences
  APSIS_JACOBIAN_EVALUATIONS = 6,   ///< calls of the Jacobian matrix
  APSIS_PRODUCT_EVALUATIONS = 7,    ///< calls of products with the Jacobian
  APSIS_FLOW_EVALUATIONS = 8,       ///< calls of the exact flow
  APSIS_EVENTS = 9,                 ///< events
  APSIS_PREPARATIONS = 10,          ///< calls of the first function of a preconditioner
  APSIS_PRECONDITIONER_SOLVES = 11  ///< calls of its second function
};
/// Returns a counter, one of apsis_counter; −1 for NULL and for an unknown counter.
long long apsis_count(const apsis_integrator* integrator, int counter);

/// Sets *of_u = 1/(1 + μ) and *of_e = μ/(1 + μ), μ = a k + |b| k², accurate to rounding for every k = C/ε
/// from 0 to infinity. A relaxation Q(u) = k (E(u) − u) that conserves the arguments of E and k has the stage
/// v = *of_u · u + *of_e · E.
void apsis_relaxation_weights(double a, double b, double k, double* of_u, double* of_e);

#ifdef __cplusplus
}
#endif

#endif
