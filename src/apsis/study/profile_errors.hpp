#pragma once

#include <apsis/config/case.hpp>
#include <apsis/study/study_control.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Predicted errors of runs with one step. Dimensionless.
struct predicted_errors {
  double dt = 0.0;                 ///< Δt
  double least_flux = 1.0,         ///< smallest flux(CΔt/ε) over the cells
      largest_flux = 1.0;          ///< largest flux(CΔt/ε) over the cells
  std::vector<double> of_moments;  ///< l2 norms over space of the errors of the densities of the invariants
};

/// Result of predict_profile_errors(). Dimensionless.
struct profile_errors {
  double smallest_epsilon = 0.0,        ///< smallest ε/C over the cells
      largest_epsilon = 0.0;            ///< largest ε/C over the cells
  std::vector<std::string> invariants;  ///< names in the order of of_moments
  std::vector<predicted_errors> rows;   ///< the step of the case, and its halvings
};

/// Predicts the temporal errors of the O(ε) terms in the conserved moments ω at time.end, for the method and
/// the step of a case and `halvings` halvings of it, without a run of the method. To leading order in Δt,
/// with any CΔt/ε, the numerical ω obeys ω_t = ℛT(E) − flux(CΔt/ε) ℛT′(E) D, as if ε were ε flux(CΔt/ε), and
/// the initial layer shifts it by −∫ (deviation in the stages) dt ℛT′(E) D₀ (at_finite_rate,
/// docs/plateaus.md). The error is the difference of two solutions by ars-443, whose flux is 1 for every
/// CΔt/ε: with this ε and these data, and with those of the case. Both are on point values, where relaxation
/// is local. Errors O(Δt^p) of the transport come in addition. C is that of the solution at half of time.end.
///
/// Throws input_error unless the model relaxes to an equilibrium of conserved moments and has space, the
/// method is IMEX with a finite flux(CΔt/ε), and the step is constant (no time.tolerance); also the errors of
/// run_setup, numerical_error where ars-443 fails, and study_interrupted.
profile_errors predict_profile_errors(const case_config& config, int halvings,
                                      const study_control& control = {});

}  // namespace apsis
