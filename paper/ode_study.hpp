#pragma once

#include <apsis/integrate/integrate.hpp>
#include <apsis/verify/ode_model.hpp>

#include <vector>

namespace apsis::paper {

/// Returns the solution at t = 1 by `steps` equal steps of a method of the catalogue.
template <class Real>
ode_state<Real> ode_solution(const method& m, Real epsilon, long steps,
                             ode_data data = ode_data::inconsistent) {
  auto problem = ode_problem(epsilon);
  stepper march(m, problem);
  auto u = ode_initial(data, epsilon);
  integrate(march, u, Real(0), Real(1), step_rule<Real>::fixed(Real(1) / static_cast<Real>(steps)));
  return u;
}

/// Returns the slope of log2 of values at steps Δt, Δt/2, Δt/4, … over log2 Δt, by least squares.
double halving_slope(const std::vector<double>& values);

}  // namespace apsis::paper
