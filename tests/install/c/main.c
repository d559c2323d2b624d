/* u1' = u2,  u2' = (1 + u1^2)(sin u1 - u2)/epsilon with epsilon = 1e-8, in steps of 1/64. */
#include <apsis/apsis.h>

#include <math.h>
#include <stdio.h>

static int transport(double t, size_t n, const double* u, double* out, void* data) {
  (void)t, (void)n, (void)data;
  out[0] = u[1];
  out[1] = 0;
  return 0;
}

/* v = u + a Q(v) + b Q'(v) Q(v) for the relaxation Q(u) = k (E - u), E = (u1, sin u1). */
static int stage(double t, double a, double b, size_t n, double* u, void* data) {
  const double* epsilon = data;
  double of_u, of_e;
  (void)t, (void)n;
  apsis_relaxation_weights(a, b, (1 + u[0] * u[0]) / *epsilon, &of_u, &of_e);
  u[1] = of_u * u[1] + of_e * sin(u[0]);
  return 0;
}

int main(void) {
  double epsilon = 1e-8;
  const double u0[] = {2, 0};
  apsis_method* method = NULL;
  apsis_integrator* s = NULL;
  int status = apsis_find_method("md-imex-6-3", &method);
  if (status == APSIS_OK) status = apsis_new_integrator(method, 2, &s);
  if (status == APSIS_OK) status = apsis_set_data(s, &epsilon);
  if (status == APSIS_OK) status = apsis_set_transport(s, transport);
  if (status == APSIS_OK) status = apsis_set_stage(s, stage);
  if (status == APSIS_OK) status = apsis_set_step(s, 1.0 / 64);
  if (status == APSIS_OK) status = apsis_start(s, 0, u0);
  if (status == APSIS_OK) status = apsis_integrate(s, 1);
  if (status == APSIS_OK)
    printf("u(1) = (%.6f, %.6f)\n", apsis_state(s)[0], apsis_state(s)[1]);
  else
    fprintf(stderr, "%s\n", apsis_error_message());
  apsis_free_integrator(s);
  apsis_free_method(method);
  return status == APSIS_OK ? 0 : 1;
}
