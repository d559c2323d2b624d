#pragma once

#include <apsis/design/design_problem.hpp>

#include <functional>
#include <string>

namespace apsis {

/// Objective of a design.
enum class design_objective {
  largest_r,       ///< the SSP coefficient r
  efficiency,      ///< r/n_F, the SSP coefficient per evaluation of T; equivalent to r for a given pattern
  smallest_error,  ///< the 2-norm of the residuals of the next order
  smallest_band,   ///< √(error² + (w band)²), where band is the error of the O(ε) term for ε ~ Δt
  smallest_mixed   ///< √(error² + w² (band² + layer²)), where layer is the norm of layer_terms()
};

/// Result of optimize().
struct program_result {
  Eigen::VectorXd x;      ///< final point; the start if Ipopt cannot be initialized
  bool solved = false;    ///< whether the first-order optimality conditions hold
  double residual = 0.0;  ///< largest |residual| of the equations at x
  std::string status;     ///< for reports: "solved", "infeasible"
};

/// Objective function: linear · x + error_weight · ½ Σ (residuals of the next order)² + band_weight ·
/// ½ Σ (band_terms())² + layer_weight · ½ Σ (layer_terms())².
struct program_goal {
  Eigen::VectorXd linear;     ///< gradient of the linear part, one entry per unknown
  double error_weight = 0.0,  ///< factor of half_square(measure::error, x)
      band_weight = 0.0,      ///< factor of half_square(measure::band, x)
      layer_weight = 0.0;     ///< factor of half_square(measure::layer, x)
};

/// Default of w in smallest_band and smallest_mixed: a band of 0.01 counts as much as an error constant of
/// 0.1, because both then cost about the same where ε(x) passes through Δt.
constexpr double default_band_weight = 10.0;

/// Returns the function to be minimized for an objective: −r, or half squares of error, band and layer.
/// `band_weight` is w.
program_goal goal_of(const design_problem& problem, design_objective objective,
                     double band_weight = default_band_weight);

/// Finds a local optimum close to x by Ipopt (Wächter, Biegler, Math. Program. 106, 2006) with exact first
/// and second derivatives. Drops equations that are linearly dependent at x, because they would make the
/// program singular. `stop` ends the iteration when it returns true. Thread-safe.
program_result optimize(design_problem& problem, const program_goal& goal, const Eigen::VectorXd& x,
                        const std::function<bool()>& stop = {}, int most_iterations = 500);

/// Returns the indices of equations with linearly independent gradients, to double precision.
std::vector<Eigen::Index> independent_equations(const Eigen::MatrixXd& jacobian);

}  // namespace apsis
