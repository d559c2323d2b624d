#include <apsis/apsis_sundials.h>

#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <sundials/sundials_context.h>

enum { cells = 200 };
static const double dx = 1.0 / cells, epsilon = 1e-6, diffusion = 1e-3;
static double inverse[2]; /* of a block: its diagonal, and the rest */

static double at(const double* u, int i) {
  return u[(i + 2 * cells) % (2 * cells)];
}

static int transport(sunrealtype t, N_Vector y, N_Vector out, void* data) {
  const double* u = N_VGetArrayPointer(y);
  (void)t, (void)data;
  for (int i = 0; i < 2 * cells; ++i) N_VGetArrayPointer(out)[i] = -(u[i] - at(u, i - 2)) / dx;
  return 0;
}

static int collision(sunrealtype t, N_Vector y, N_Vector out, void* data) {
  const double* u = N_VGetArrayPointer(y);
  (void)t, (void)data;
  for (int i = 0; i < 2 * cells; ++i)
    N_VGetArrayPointer(out)[i] =
        diffusion / (dx * dx) * (at(u, i - 2) - 2 * u[i] + at(u, i + 2)) + (u[i ^ 1] - u[i]) / epsilon;
  return 0;
}

/* Q is linear: its product with the Jacobian is Q itself. */
static int product(N_Vector v, N_Vector jv, sunrealtype t, N_Vector y, N_Vector fy, void* data,
                   N_Vector work) {
  (void)y, (void)fy, (void)work;
  return collision(t, v, jv, data);
}

static int setup(sunrealtype t, N_Vector y, N_Vector fy, int jok, int* jcur, sunrealtype gamma, void* data) {
  const double other = -gamma / epsilon, own = 1 + 2 * gamma * diffusion / (dx * dx) - other;
  const double det = (own - other) * (own + other);
  (void)t, (void)y, (void)fy, (void)jok, (void)data;
  inverse[0] = own / det;
  inverse[1] = -other / det;
  *jcur = 1;
  return 0;
}

static int solve(sunrealtype t, N_Vector y, N_Vector fy, N_Vector r, N_Vector z, sunrealtype gamma,
                 sunrealtype delta, int lr, void* data) {
  const double* from = N_VGetArrayPointer(r);
  (void)t, (void)y, (void)fy, (void)gamma, (void)delta, (void)lr, (void)data;
  for (int i = 0; i < 2 * cells; ++i)
    N_VGetArrayPointer(z)[i] = inverse[0] * from[i] + inverse[1] * from[i ^ 1];
  return 0;
}

int main(void) {
  SUNContext context = NULL;
  apsis_method* method = NULL;
  apsis_sundials* s = NULL;
  SUNContext_Create(NULL, &context);
  N_Vector y = N_VNew_Serial(2 * cells, context);
  for (int i = 0; i < 2 * cells; ++i)
    N_VGetArrayPointer(y)[i] = i % 2 == 0 ? 2 * pow(sin(M_PI * dx * i / 2), 2) : 0;
  int status = apsis_find_method("md-imex-10-3-mixed", &method);
  if (status == APSIS_OK) status = apsis_sundials_create(method, transport, collision, 0, y, context, &s);
  if (status == APSIS_OK) status = apsis_sundials_set_products(s, NULL, product);
  if (status == APSIS_OK) status = apsis_sundials_set_preconditioner(s, setup, solve);
  if (status == APSIS_OK) status = apsis_sundials_set_tolerance(s, 1e-5, 1e-7);
  if (status == APSIS_OK) status = apsis_sundials_evolve(s, 0.25, y, NULL);
  if (status == APSIS_OK)
    printf("%lld steps, u from %.4f to %.4f\n", apsis_sundials_count(s, APSIS_SUNDIALS_STEPS), N_VMin(y),
           N_VMaxNorm(y));
  else
    fprintf(stderr, "%s\n", apsis_error_message());
  apsis_sundials_free(s);
  apsis_free_method(method);
  N_VDestroy(y);
  SUNContext_Free(&context);
  return status == APSIS_OK ? 0 : 1;
}
