// The ODE model of the paper: the reference agrees with an independent integrator, and the data lie on the
// slow manifold.
#include <apsis/verify/ode_model.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace apsis::ode_model_test {
namespace {

using state = ode_state<long double>;

state slope(const state& u, long double epsilon) {
  return {u[1], (1 + u[0] * u[0]) * (std::sin(u[0]) - u[1]) / epsilon};
}

/// Takes steps of the classical method of order four.
state runge_kutta(state u, long double epsilon, long steps) {
  const long double dt = 1.0L / static_cast<long double>(steps);
  const auto moved = [](const state& v, long double by, const state& k) -> state {
    return {v[0] + by * k[0], v[1] + by * k[1]};
  };
  for (long step = 0; step < steps; ++step) {
    const state a = slope(u, epsilon), b = slope(moved(u, dt / 2, a), epsilon),
                c = slope(moved(u, dt / 2, b), epsilon), d = slope(moved(u, dt, c), epsilon);
    for (std::size_t k = 0; k < 2; ++k) u[k] += dt / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
  }
  return u;
}

TEST(ode_model, the_reference_is_the_solution_for_moderate_epsilon) {
  for (const double epsilon : {1.0, 0.1})
    for (const auto data : {ode_data::inconsistent, ode_data::consistent}) {
      const long double e = epsilon;
      // With dt C/ε ≤ 1/100 the error of order four is far below the 1e-13 of the reference.
      const state exact = runge_kutta(ode_initial(data, e), e, 20000);
      EXPECT_LT(ode_distance(ode_reference(epsilon, data), exact), 1e-12) << epsilon;
    }
}

TEST(ode_model, the_reference_tends_to_the_solution_of_the_limit_as_epsilon) {
  // u' = sin u from 2 has the solution tan(u/2) = tan(1) e^t.
  const long double u = 2 * std::atan(std::tan(1.0L) * std::exp(1.0L));
  const state limit{u, std::sin(u)};
  for (const auto data : {ode_data::inconsistent, ode_data::consistent}) {
    const double coarse = ode_distance(ode_reference(1e-6, data), limit),
                 fine = ode_distance(ode_reference(1e-7, data), limit);
    EXPECT_NEAR(coarse / fine, 10.0, 1e-3);  // the next term is smaller by 1e-6
    EXPECT_LT(coarse, 1e-6);
  }
}

TEST(ode_model, consistent_data_lie_on_the_slow_manifold) {
  // On the slow manifold u2' = E'(u1) u1' + O(ε). Elsewhere u2' is of size 1/ε.
  const auto defect = [](ode_data data, long double epsilon) {
    const state u = ode_initial(data, epsilon);
    return std::abs(slope(u, epsilon)[1] - std::cos(u[0]) * u[1]);
  };
  EXPECT_NEAR(static_cast<double>(defect(ode_data::consistent, 1e-3L) / defect(ode_data::consistent, 1e-4L)),
              10.0, 1e-2);
  EXPECT_LT(defect(ode_data::consistent, 1e-4L), 1e-4L);
  EXPECT_GT(defect(ode_data::inconsistent, 1e-4L), 1e4L);
}

}  // namespace
}  // namespace apsis::ode_model_test
