#include "internal/functions.hpp"

#include <apsis/c/internal/guarded.hpp>
#include <apsis/core/errors.hpp>

#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

namespace apsis::sundials {

void require_operation(const char* name, bool there, const char* use) {
  if (!there)
    throw input_error(fmt::format("the vectors have no operation '{}' ({}); add it to their ops", name, use));
}

bool is_finite(N_Vector v) {
  // The maximum norm of some vectors ignores NaN.
  return std::isfinite(N_VL1Norm(v));
}

namespace {

void require_finite(N_Vector v, const char* name, double t) {
  if (!is_finite(v))
    throw numerical_error(fmt::format(
        "the result of the callback '{}' at t = {:.10g} is not finite (NaN or infinity); reduce the time "
        "step, or check the callback",
        name, t));
}

}  // namespace

void functions::evaluate_transport(double t, N_Vector y, N_Vector out) {
  evaluate(transport, "transport", APSIS_SUNDIALS_TRANSPORT_EVALUATIONS, t, y, out);
}

void functions::evaluate_collision(double t, N_Vector y, N_Vector out) {
  evaluate(collision, "collision", APSIS_SUNDIALS_COLLISION_EVALUATIONS, t, y, out);
}

void functions::evaluate(apsis_sundials_rate_function* rate, const char* name, apsis_sundials_counter counter,
                         double t, N_Vector y, N_Vector out) {
  if (rate == nullptr) {
    N_VConst(0.0, out);
    return;
  }
  count(counter);
  c::require_success(name, rate(t, y, out, data));
  require_finite(out, name, t);
}

bool functions::try_collision(double t, N_Vector y, N_Vector out) {
  count(APSIS_SUNDIALS_COLLISION_EVALUATIONS);
  const int returned = collision(t, y, out, data);
  if (returned < 0) c::throw_refusal("collision", returned);
  return returned == 0 && is_finite(out);
}

double functions::time_of(apsis_sundials_time_function* function, const char* name, double t,
                          N_Vector y) const {
  if (function == nullptr) return std::numeric_limits<double>::infinity();
  double result = std::numeric_limits<double>::quiet_NaN();
  c::require_success(name, function(y, t, &result, data));
  if (!(result > 0.0))
    throw numerical_error(fmt::format(
        "the callback '{}' returns the time {} (it must be above 0); check the callback", name, result));
  return result;
}

}  // namespace apsis::sundials
