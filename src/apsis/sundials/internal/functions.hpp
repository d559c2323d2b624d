#pragma once

#include "nvector.hpp"

#include <apsis/apsis_sundials.h>
#include <apsis/c/internal/observing_thread.hpp>

#include <array>
#include <cstddef>

namespace apsis::sundials {

/// The functions of a program, and how often they were called.
struct functions {
  void* data = nullptr;
  apsis_sundials_rate_function *transport = nullptr, *collision = nullptr;
  apsis_sundials_product_setup* product_setup = nullptr;
  apsis_sundials_product_function* product = nullptr;
  apsis_sundials_jacobian_function* jacobian = nullptr;
  apsis_sundials_preconditioner_setup* preconditioner_setup = nullptr;
  apsis_sundials_preconditioner_solve* preconditioner = nullptr;
  apsis_sundials_stage_function* stage = nullptr;
  apsis_sundials_time_function *forward_euler_step = nullptr, *relaxation_time = nullptr;
  apsis_sundials_root_function* roots = nullptr;
  apsis_sundials_observer* observer = nullptr;
  SUNLinearSolver solver = nullptr;  ///< of the program; NULL for one of the integrator
  SUNMatrix matrix = nullptr;
  SUNContext context = nullptr;
  c::observing_thread observing{};
  std::array<long long, APSIS_SUNDIALS_EVENTS + 1> counts{};

  void count(apsis_sundials_counter which, long long more = 1) {
    counts[static_cast<std::size_t>(which)] += more;
  }

  /// out ← T(t, y); 0 without T. Throws numerical_error if T is not finite.
  void evaluate_transport(double t, N_Vector y, N_Vector out);
  /// out ← Q(t, y); 0 without Q. Throws numerical_error if Q is not finite.
  void evaluate_collision(double t, N_Vector y, N_Vector out);
  /// Like evaluate_collision(), for a state that Newton's method tries. Returns whether Q accepts the state
  /// and is finite. Throws callback_error if the callback fails.
  bool try_collision(double t, N_Vector y, N_Vector out);
  /// Returns the result of a time_function; +infinity without one.
  double time_of(apsis_sundials_time_function* function, const char* name, double t, N_Vector y) const;

 private:
  void evaluate(apsis_sundials_rate_function* rate, const char* name, apsis_sundials_counter counter,
                double t, N_Vector y, N_Vector out);
};

/// Whether all elements are finite. Elements whose absolute values add up to more than 1e308 count as
/// infinite.
bool is_finite(N_Vector v);

}  // namespace apsis::sundials
