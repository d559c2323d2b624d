#include <apsis/core/version.hpp>

#include <apsis/apsis.h>
#include <apsis/core/relaxation_weights.hpp>

int apsis_abi_version(void) {
  return APSIS_ABI_VERSION;
}

const char* apsis_version(void) {
  return apsis::version();
}

void apsis_relaxation_weights(double a, double b, double k, double* of_u, double* of_e) {
  const auto weights = apsis::relax_weights(a, b, k, 1.0);
  if (of_u != nullptr) *of_u = weights.of_u;
  if (of_e != nullptr) *of_e = weights.of_e;
}
