#pragma once

#include <apsis/config/case.hpp>
#include <apsis/study/study_control.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Predicted errors of a run with one step length. Dimensionless.
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
  std::vector<predicted_errors> rows;   ///< for the step of the case, and for its halvings
};

/// Predicts the temporal errors of the O(ε) terms in the conserved moments ω at time.end, without a
/// run of the method. The prediction is for the method and the step of a case, and for `halvings`
/// halvings of the step.
///
/// To leading order in Δt, with any CΔt/ε, the numerical ω obeys ω_t = ℛT(E) − flux(CΔt/ε) ℛT′(E) D, as if ε
/// were ε flux(CΔt/ε). The initial layer shifts ω by −∫ (deviation in the stages) dt ℛT′(E) D₀
/// (at_finite_rate, docs/plateaus.md). The error is the difference of two ars-443 solutions, with modified
/// and with original ε and data. The flux of ars-443 is 1 for every CΔt/ε. Both solutions are on point
/// values, where relaxation is local. Errors O(Δt^p) of the transport come in addition. C is that of the
/// solution at half of time.end.
///
/// Throws input_error unless the model relaxes to an equilibrium of conserved moments and has space. Also
/// throws it unless the method is IMEX with a finite flux(CΔt/ε), and the step is constant (no
/// time.tolerance). Throws the errors of run_setup, numerical_error if ars-443 fails, and study_interrupted.
profile_errors predict_profile_errors(const case_config& config, int halvings,
                                      const study_control& control = {});

}  // namespace apsis
