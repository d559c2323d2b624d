// Owners of C handles for the tests.
#pragma once

#include <apsis/apsis_sundials.h>

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

#ifndef SUN_COMM_NULL
#define SUN_COMM_NULL nullptr  // before version 7
#endif

namespace sundials_test {

/// Returns a context of SUNDIALS without MPI.
inline SUNContext context() {
  static SUNContext made = [] {
    SUNContext one = nullptr;
    SUNContext_Create(SUN_COMM_NULL, &one);
    return one;
  }();
  return made;
}

using vector = std::unique_ptr<std::remove_pointer_t<N_Vector>, decltype(&N_VDestroy)>;
using integrator = std::unique_ptr<apsis_sundials, decltype(&apsis_sundials_free)>;
using method = std::unique_ptr<apsis_method, decltype(&apsis_free_method)>;

inline vector owned(N_Vector v) {
  return {v, N_VDestroy};
}

inline vector serial(const std::vector<double>& values) {
  auto made = owned(N_VNew_Serial(static_cast<sunindextype>(values.size()), context()));
  for (std::size_t i = 0; i < values.size(); ++i) N_VGetArrayPointer(made.get())[i] = values[i];
  return made;
}

inline std::vector<double> values(N_Vector v) {
  const double* from = N_VGetArrayPointer(v);
  return {from, from + N_VGetLength(v)};
}

inline method find(const std::string& name) {
  apsis_method* found = nullptr;
  EXPECT_EQ(apsis_find_method(name.c_str(), &found), APSIS_OK) << apsis_error_message();
  return {found, apsis_free_method};
}

inline integrator make(const std::string& name, apsis_sundials_rate_function* transport,
                       apsis_sundials_rate_function* collision, double t0, N_Vector y0,
                       void* data = nullptr) {
  apsis_sundials* made = nullptr;
  EXPECT_EQ(apsis_sundials_create(find(name).get(), transport, collision, t0, y0, context(), &made), APSIS_OK)
      << apsis_error_message();
  apsis_sundials_set_user_data(made, data);
  return {made, apsis_sundials_free};
}

/// Expects success, and otherwise shows the message.
inline void expect_ok(int status) {
  EXPECT_EQ(status, APSIS_OK) << apsis_error_message();
}

}  // namespace sundials_test
