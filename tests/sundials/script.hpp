// A model of two unknowns with callbacks that fail on demand.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <sundials/support.hpp>

namespace sundials_test {

/// u' = cos t + Q, v' = −Q with Q = −(u − v)/ε. The callbacks fail from a given time on.
struct script {
  double epsilon = 0.1;
  double from = std::numeric_limits<double>::infinity();  ///< time from which callbacks behave as below
  int answer = 0;
  double value = 0.0;  ///< number that is then added to T
  apsis_sundials* called = nullptr;
  std::vector<int> statuses{};
  std::vector<double> seen{};
};

inline int transport(double t, N_Vector, N_Vector out, void* data) {
  const auto& now = *static_cast<const script*>(data);
  N_VGetArrayPointer(out)[0] = std::cos(t) + (t >= now.from ? now.value : 0.0);
  N_VGetArrayPointer(out)[1] = 0.0;
  return t >= now.from ? now.answer : 0;
}

inline int collision(double, N_Vector y, N_Vector out, void* data) {
  const double* u = N_VGetArrayPointer(y);
  const double rate = (u[0] - u[1]) / static_cast<const script*>(data)->epsilon;
  N_VGetArrayPointer(out)[0] = -rate;
  N_VGetArrayPointer(out)[1] = rate;
  return 0;
}

/// Solves the stage exactly: w = u − v has the rate −2w/ε.
inline int stage(double, double a, double b, N_Vector y, void* data) {
  double* u = N_VGetArrayPointer(y);
  double of_u = 0, of_e = 0;
  apsis_relaxation_weights(a, b, 2.0 / static_cast<const script*>(data)->epsilon, &of_u, &of_e);
  const double mean = (u[0] + u[1]) / 2, half = (u[0] - u[1]) / 2 * of_u;
  u[0] = mean + half;
  u[1] = mean - half;
  return 0;
}

inline integrator of_script(const std::string& name, script& data) {
  auto s = make(name, transport, collision, 0.0, serial({1, 0}).get(), &data);
  expect_ok(apsis_sundials_set_step(s.get(), 1.0 / 64));
  return s;
}

/// The mean of u and v is (1 + sin t)/2.
inline int mean_minus_most(double t, N_Vector y, double* g, void*) {
  const double* u = N_VGetArrayPointer(y);
  g[0] = (u[0] + u[1]) / 2 - 0.8;
  g[1] = std::sin(20 * t);
  return 0;
}

}  // namespace sundials_test
