#pragma once

#include <apsis/integrate/newton_problem.hpp>
#include <apsis/integrate/relaxation_problem.hpp>

#include <array>
#include <cmath>
#include <vector>

/// The ODE model of the paper (eq. vdp): u1' = u2, u2' = (1 + u1²)(sin u1 − u2)/ε, u(0) = (2, 0), T = 1.
namespace ode_model {

template <class State>
State initial_state() {
  State u;
  if constexpr (requires { u.resize(2); }) u.resize(2);
  u[0] = 2;
  u[1] = 0;
  return u;
}

inline constexpr auto transport = [](auto, const auto& u, auto& out) {
  out[0] = u[1];
  out[1] = 0;
};

/// Returns Q(u)/ε for any scalar type. The reference solvers add the transport.
template <class Real>
auto collision(Real epsilon) {
  return [epsilon](const auto& u, auto& out) {
    using std::sin;
    out[0] = 0 * u[0];
    out[1] = (1 + u[0] * u[0]) * (sin(u[0]) - u[1]) / epsilon;
  };
}

template <class State = std::vector<double>>
auto as_relaxation(apsis::state_real<State> epsilon) {
  using real = apsis::state_real<State>;
  return apsis::make_relaxation_problem<State>(
      transport, [](const auto& u) { return real(u[0]); },
      [](real w, auto& out) {
        out[0] = w;
        out[1] = std::sin(w);
      },
      [](real w) { return 1 + w * w; }, epsilon);
}

template <class State = std::vector<double>>
auto as_newton(apsis::state_real<State> epsilon, apsis::newton_options options = {}) {
  return apsis::make_newton_problem<State>(transport, collision(epsilon), options);
}

}  // namespace ode_model
