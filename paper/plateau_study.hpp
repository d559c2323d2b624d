#pragma once

#include <apsis/config/case.hpp>
#include <apsis/method/intermediate_regime.hpp>

#include <string>
#include <vector>

#include <paper/claim.hpp>
#include <paper/ode_study.hpp>

namespace apsis::paper {

/// The terms of size ε of a method on a case (docs/plateaus.md), each relative to the term of the exact
/// solution, for ε = 1e-6. Two runs with steps Δt and Δt/2 are extrapolated to Δt → 0.
struct measured_regime {
  double flux,  ///< term of size ε in ω at the end, from data at equilibrium
      last,     ///< deviation E(ℛu) − u at the end, from data at equilibrium
      layer;    ///< effect on ω of the initial layer of the data as given
};

/// Measures the terms of each method. The difference of its solutions for ε and for ε = 0, which contains no
/// errors Δt^p, is projected on the same difference of exact solutions. `layer` compares data as given with
/// the same data at equilibrium. Throws the errors of time_study.
std::vector<measured_regime> measure_regimes(const case_config& config,
                                             const std::vector<std::string>& methods, long steps,
                                             const study_control& control = {});

/// Returns the errors of u1 and u2 of the ODE model at t = 1 over ε, on a plateau (ε → 0, then Δt → 0), as
/// `regime` predicts them:
///   e1 = (1 − flux) E(u) ∫_2^u E′/(C E) dw + [data given] (1 − layer) E(u)/C(2),   E = sin, C = 1 + w²,
///   e2 = E′(u) e1 + (1 − last) E′(u) E(u)/C(u),   u the limit solution at t = 1.
std::array<double, 2> predicted_ode_plateau(const intermediate_regime<double>& regime, ode_data data);

/// Returns the same errors as measured: the error of the part of size ε for ε = 1e-9, in long double,
/// extrapolated to Δt → 0.
std::array<double, 2> measured_ode_plateau(const method& m, ode_data data);

/// Adds findings, tables and pictures on the causes of the plateaus and their prediction by the coefficients.
void add_plateau_study(const std::string& id, const study_control& control, claim_result& result);

}  // namespace apsis::paper
