#pragma once

#include <apsis/integrate/extrapolation.hpp>
#include <apsis/integrate/relaxation_problem.hpp>

#include <array>
#include <cmath>

namespace apsis {

/// A state of the ODE model of the paper (eq. vdp, numerical section) in any precision. The model is u1' =
/// u2, u2' = (1 + u1²)(sin u1 − u2)/ε, from t = 0 to 1. Dimensionless.
template <class Real>
using ode_state = std::array<Real, 2>;

/// Returns the model for integrate() and extrapolate(). Every stage has a closed-form solution.
template <class Real>
auto ode_problem(Real epsilon) {
  return make_relaxation_problem<ode_state<Real>>(
      [](Real, const auto& u, auto& out) { out = {u[1], Real(0)}; }, [](const auto& u) { return u[0]; },
      [](Real w, auto& out) { out = {w, std::sin(w)}; }, [](Real w) { return Real(1) + w * w; }, epsilon);
}

/// Initial data of the ODE model.
enum class ode_data {
  inconsistent,  ///< u = (2, 0), far from equilibrium (the paper's)
  consistent     ///< u2 = E − ε E′E/C with E = sin 2, C = 5: the slow manifold up to O(ε²)
};

/// Returns the initial value u(0) of these data.
template <class Real>
ode_state<Real> ode_initial(ode_data data, Real epsilon) {
  if (data == ode_data::inconsistent) return {2, 0};
  return {2, std::sin(Real(2)) - epsilon * std::cos(Real(2)) * std::sin(Real(2)) / 5};
}

/// Returns the paper's measure of error: |Δu1| + |Δu2|.
template <class Real, class Other>
double ode_distance(const ode_state<Real>& u, const ode_state<Other>& v) {
  return static_cast<double>(std::abs(u[0] - v[0]) + std::abs(u[1] - v[1]));
}

/// Returns the solution at t = 1 to 1e-13 for every ε, by extrapolation in long double.
ode_state<long double> ode_reference(double epsilon, ode_data data = ode_data::inconsistent,
                                     extrapolation_options<long double> how = {1e-13L});

}  // namespace apsis
