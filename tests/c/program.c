/* A program in C that uses Apsis only through apsis.h: the model of the paper, observed orders, and errors.
   u1' = u2,  u2' = (1 + u1^2)(sin u1 - u2)/epsilon,  u(0) = (2, 0). */
#include <apsis/apsis.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;

#define CHECK(condition)                                                                          \
  do {                                                                                            \
    if (!(condition)) {                                                                           \
      fprintf(stderr, "%s:%d: %s (%s)\n", __FILE__, __LINE__, #condition, apsis_error_message()); \
      ++failures;                                                                                 \
    }                                                                                             \
  } while (0)

struct model {
  double epsilon;
  double fails_from; /* the transport returns `answer` from this time on */
  int answer;
  int gives_nan;
};

static int transport(double t, size_t n, const double* u, double* out, void* data) {
  const struct model* m = data;
  (void)n;
  out[0] = u[1];
  out[1] = 0;
  if (t < m->fails_from) return 0;
  if (m->gives_nan) out[1] = sqrt(-1.0);
  return m->answer;
}

static int stage(double t, double a, double b, size_t n, double* u, void* data) {
  const struct model* m = data;
  const double w = u[0];
  double of_u, of_e;
  (void)t;
  (void)n;
  apsis_relaxation_weights(a, b, (1 + w * w) / m->epsilon, &of_u, &of_e);
  u[1] = of_u * u[1] + of_e * sin(w);
  return 0;
}

static int rate(size_t block, size_t n, const double* u, double* q, void* data) {
  const struct model* m = data;
  (void)block;
  (void)n;
  q[0] = 0;
  q[1] = (1 + u[0] * u[0]) * (sin(u[0]) - u[1]) / m->epsilon;
  return 0;
}

static int jacobian(size_t block, size_t n, const double* u, double* j, void* data) {
  const struct model* m = data;
  (void)block;
  (void)n;
  j[0] = 0;
  j[1] = 0;
  j[2] = (2 * u[0] * (sin(u[0]) - u[1]) + (1 + u[0] * u[0]) * cos(u[0])) / m->epsilon;
  j[3] = -(1 + u[0] * u[0]) / m->epsilon;
  return 0;
}

/* Returns an integrator of the model with steps 1/steps. If steps is 0, a tolerance controls the steps. */
static apsis_integrator* integrator_of(const char* name, struct model* m, int by_newton, int steps) {
  static const double u0[2] = {2, 0};
  apsis_method* method = NULL;
  apsis_integrator* s = NULL;
  CHECK(apsis_find_method(name, &method) == APSIS_OK);
  CHECK(apsis_new_integrator(method, 2, &s) == APSIS_OK);
  apsis_free_method(method);
  CHECK(apsis_set_data(s, m) == APSIS_OK);
  CHECK(apsis_set_transport(s, transport) == APSIS_OK);
  if (by_newton) {
    CHECK(apsis_set_rate(s, rate) == APSIS_OK);
    CHECK(apsis_set_jacobian(s, jacobian) == APSIS_OK);
  } else {
    CHECK(apsis_set_stage(s, stage) == APSIS_OK);
  }
  if (steps > 0) {
    CHECK(apsis_set_step(s, 1.0 / steps) == APSIS_OK);
  } else {
    CHECK(apsis_set_tolerance(s, 0, 1e-4) == APSIS_OK);
  }
  CHECK(apsis_start(s, 0, u0) == APSIS_OK);
  return s;
}

/* Returns |du1| + |du2| at the time reached. */
static double distance(const apsis_integrator* s, const double u[2]) {
  const double* v = apsis_state(s);
  return fabs(v[0] - u[0]) + fabs(v[1] - u[1]);
}

/* The reference solution of examples/quickstart.cpp. */
static void solves_the_model_of_the_paper(void) {
  static const double reference[2] = {2.677671, 0.447459};
  struct model m = {1e-8, 2, 0, 0};
  int by_newton;
  for (by_newton = 0; by_newton <= 1; ++by_newton) {
    apsis_integrator* s = integrator_of("md-imex-6-3", &m, by_newton, 64);
    CHECK(apsis_integrate(s, 1) == APSIS_OK);
    CHECK(apsis_time(s) == 1);
    CHECK(distance(s, reference) < 1e-6); /* half a unit of the last digit, twice */
    CHECK(apsis_count(s, APSIS_STEPS) == 64);
    apsis_free_integrator(s);
  }
}

/* The solution with 1024 steps is the reference at epsilon = 1. Its error is 500 times smaller. */
static void converges_with_the_order_of_the_method(const char* name, int by_newton) {
  struct model m = {1, 2, 0, 0};
  double reference[2], errors[2];
  int k, order;
  apsis_method* method = NULL;
  apsis_integrator* s = integrator_of(name, &m, by_newton, 1024);
  CHECK(apsis_find_method(name, &method) == APSIS_OK);
  order = apsis_method_order(method);
  apsis_free_method(method);
  CHECK(apsis_integrate(s, 1) == APSIS_OK);
  memcpy(reference, apsis_state(s), sizeof reference);
  apsis_free_integrator(s);
  for (k = 0; k < 2; ++k) {
    s = integrator_of(name, &m, by_newton, 64 << k);
    CHECK(apsis_integrate(s, 1) == APSIS_OK);
    errors[k] = distance(s, reference);
    apsis_free_integrator(s);
  }
  CHECK(fabs(log2(errors[0] / errors[1]) - order) < 0.2);
}

static void reports_bad_input(void) {
  apsis_method* method = NULL;
  CHECK(apsis_find_method("md-imex-6-33", &method) == APSIS_INPUT_ERROR);
  CHECK(method == NULL);
  CHECK(strstr(apsis_error_message(),
               "unknown method 'md-imex-6-33' (there is no such name); did you mean "
               "'md-imex-6-3'?") != NULL);
}

static void reports_callbacks_that_fail(void) {
  struct model m = {0.1, 0.5, -3, 0};
  apsis_integrator* s = integrator_of("md-imex-6-3", &m, 0, 64);
  CHECK(apsis_integrate(s, 1) == APSIS_CALLBACK_ERROR);
  CHECK(strstr(apsis_error_message(), "the callback 'transport' failed (it returned -3)") != NULL);
  CHECK(strstr(apsis_error_message(), "[step ") != NULL);
  CHECK(apsis_time(s) > 0.4 && apsis_time(s) <= 0.5);
  m.answer = 0; /* the state is that of the last accepted step */
  CHECK(apsis_integrate(s, 1) == APSIS_OK);
  apsis_free_integrator(s);

  m.gives_nan = 1;
  s = integrator_of("md-imex-6-3", &m, 0, 64);
  CHECK(apsis_integrate(s, 1) == APSIS_NUMERICAL_ERROR);
  CHECK(strstr(apsis_error_message(), "the result of the callback 'transport' is not finite (component 1)") !=
        NULL);
  apsis_free_integrator(s);
}

static int count_to_three(long long step, double t, double dt, size_t n, const double* u, void* data) {
  (void)t;
  (void)dt;
  (void)n;
  (void)u;
  (void)data;
  return step == 3;
}

static void stops_at_the_observer_and_follows_a_tolerance(void) {
  static const double reference[2] = {2.677671, 0.447459};
  struct model m = {1e-8, 2, 0, 0};
  apsis_integrator* s = integrator_of("md-imex-6-3", &m, 1, 0);
  CHECK(apsis_set_observer(s, count_to_three) == APSIS_OK);
  CHECK(apsis_integrate(s, 1) == APSIS_STOPPED);
  CHECK(apsis_count(s, APSIS_STEPS) == 3);
  CHECK(apsis_set_observer(s, NULL) == APSIS_OK);
  CHECK(apsis_integrate(s, 1) == APSIS_OK);
  CHECK(distance(s, reference) < 1e-3); /* ten tolerances of a step */
  apsis_free_integrator(s);
}

static int level(double t, size_t n, const double* u, size_t count, double* g, void* data) {
  (void)t;
  (void)n;
  (void)data;
  if (count != 1) return -1;
  g[0] = u[0] - 2.5;
  return 0;
}

/* At epsilon = 0, tan(u1/2) = tan(1) e^t, so u1 = 2.5 at log(tan(1.25)/tan(1)). The tolerance covers epsilon
 * and the error of order 3. */
static void finds_an_event_in_dense_output(void) {
  struct model m = {1e-8, 2, 0, 0};
  apsis_integrator* s = integrator_of("md-imex-6-3", &m, 0, 64);
  size_t k = 1;
  double t = 0, u[2];
  const double expected = log(tan(1.25) / tan(1));
  CHECK(apsis_set_events(s, 1, level, NULL, NULL) == APSIS_OK);
  CHECK(apsis_integrate(s, 1) == APSIS_EVENT);
  CHECK(apsis_count(s, APSIS_EVENTS) == 1);
  CHECK(apsis_found_event(s, 0, &k, &t) == APSIS_OK);
  CHECK(k == 0 && t == apsis_time(s));
  CHECK(fabs(t - expected) < 1e-6);
  CHECK(apsis_state_at(s, t, u) == APSIS_OK);
  CHECK(fabs(u[0] - 2.5) < 1e-13 && fabs(u[1] - sin(u[0])) < 1e-6);
  CHECK(apsis_integrate(s, 1) == APSIS_OK); /* the event was left behind */
  apsis_free_integrator(s);
}

int main(void) {
  CHECK(apsis_abi_version() == APSIS_ABI_VERSION);
  CHECK(strlen(apsis_version()) >= 5);
  solves_the_model_of_the_paper();
  converges_with_the_order_of_the_method("md-imex-6-3", 0);
  converges_with_the_order_of_the_method("md-imex-6-3", 1);
  converges_with_the_order_of_the_method("imex-bdf-3", 1);
  reports_bad_input();
  reports_callbacks_that_fail();
  stops_at_the_observer_and_follows_a_tolerance();
  finds_an_event_in_dense_output();
  printf("%d failures\n", failures);
  return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
