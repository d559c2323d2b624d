#pragma once

#include <apsis/apsis.h>
#include <apsis/core/errors.hpp>
#include <apsis/core/relaxation_flow.hpp>

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

/// Callbacks for the ODE model of the paper, and handles that release themselves.
namespace c_interface {

struct free_method {
  void operator()(apsis_method* m) const { apsis_free_method(m); }
};
struct free_integrator {
  void operator()(apsis_integrator* s) const { apsis_free_integrator(s); }
};
using method = std::unique_ptr<apsis_method, free_method>;
using integrator = std::unique_ptr<apsis_integrator, free_integrator>;

inline method find(const char* name) {
  apsis_method* found = nullptr;
  EXPECT_EQ(apsis_find_method(name, &found), APSIS_OK) << apsis_error_message();
  return method(found);
}

inline integrator make(const char* name, std::size_t n) {
  apsis_integrator* made = nullptr;
  EXPECT_EQ(apsis_new_integrator(find(name).get(), n, &made), APSIS_OK) << apsis_error_message();
  return integrator(made);
}

/// Returns the n unknowns of an integrator.
inline std::vector<double> unknowns_of(const integrator& s, std::size_t n) {
  const double* u = apsis_state(s.get());
  return {u, u + n};
}

/// Throws the error of a function of the C interface, as tables of bad input expect.
inline void rethrow(int status) {
  if (status >= 0) return;
  EXPECT_EQ(status, APSIS_INPUT_ERROR);
  throw apsis::input_error(apsis_error_message());
}

/// ε, the data of the callbacks.
struct ode {
  double epsilon;
};

inline double rate_of(const double* u, void* data) {
  return (1 + u[0] * u[0]) / static_cast<const ode*>(data)->epsilon;
}

inline int transport(double, size_t, const double* u, double* out, void*) {
  out[0] = u[1];
  out[1] = 0;
  return 0;
}

inline int stage(double, double a, double b, size_t, double* u, void* data) {
  double of_u, of_e;
  apsis_relaxation_weights(a, b, rate_of(u, data), &of_u, &of_e);
  const double w = u[0], e = std::sin(w);
  u[0] = of_u * w + of_e * w;  // rounded like every component
  u[1] = of_u * u[1] + of_e * e;
  return 0;
}

inline int flow(double, double s, size_t, double* u, void* data) {
  const double w = u[0], e = std::sin(w);
  const auto weights = apsis::flow_weights(s, 1 + w * w, static_cast<const ode*>(data)->epsilon);
  u[0] = weights.of_u * u[0] + weights.of_e * w;
  u[1] = weights.of_u * u[1] + weights.of_e * e;
  return 0;
}

/// Computes Q with the operations of relaxation_problem.
inline int rate(size_t, size_t, const double* u, double* q, void* data) {
  const double k = rate_of(u, data);
  q[0] = k * (u[0] - u[0]);
  q[1] = k * (std::sin(u[0]) - u[1]);
  return 0;
}

inline int relaxation_time(double, size_t, const double* u, double* result, void* data) {
  *result = static_cast<const ode*>(data)->epsilon / (1 + u[0] * u[0]);
  return 0;
}

/// Returns an integrator of the model from (2, 0) at t = 0 with all callbacks for the
/// collision except derivatives.
inline integrator of_ode(const char* name, ode& data) {
  auto s = make(name, 2);
  apsis_set_data(s.get(), &data);
  apsis_set_transport(s.get(), transport);
  apsis_set_stage(s.get(), stage);
  apsis_set_rate(s.get(), rate);
  apsis_set_flow(s.get(), flow);
  const double u0[] = {2, 0};
  EXPECT_EQ(apsis_start(s.get(), 0, u0), APSIS_OK);
  return s;
}

}  // namespace c_interface
