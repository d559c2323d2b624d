#pragma once

#include <apsis/design/design_problem.hpp>

#include <functional>
#include <string>

namespace apsis {

/// What a design is to be best in.
enum class design_objective {
  largest_r,       ///< the SSP coefficient r
  efficiency,      ///< r/n_F, what one evaluation of T pays for; the same as r for a given pattern
  smallest_error,  ///< the 2-norm of the residuals of the next order
  smallest_band    ///< √(error² + (10 band)²), with the error of the term of size ε where ε ~ Δt
};

/// How an optimisation ended.
struct program_result {
  Eigen::VectorXd x;      ///< where it ended; the start if Ipopt does not start
  bool solved = false;    ///< a point where the first-order conditions hold
  double residual = 0.0;  ///< largest |equation| there
  std::string status;     ///< for reports: "solved", "infeasible"
};

/// What a program minimises: linear · x + error_weight · ½ Σ (residuals of the next order)² + band_weight · ½
/// Σ (band_terms())².
struct program_goal {
  Eigen::VectorXd linear;     ///< gradient of the linear part, one number for each unknown
  double error_weight = 0.0,  ///< factor of half_square(measure::error, x)
      band_weight = 0.0;      ///< factor of half_square(measure::band, x)
};

/// In smallest_band a band of 0.01 counts as much as an error constant of 0.1: both then cost about the same
/// where ε(x) goes through Δt.
constexpr double band_to_error = 10.0;

/// The goal of an objective: −r, the error, or the band.
program_goal goal_of(const design_problem& problem, design_objective objective);

/// The best method near x: Ipopt (Wächter, Biegler, Math. Program. 106, 2006) with exact first and second
/// derivatives. Of equations that depend on others at x, which makes a program singular, only independent
/// ones are passed on. `stop` ends the iteration when it returns true. May be called from several threads.
program_result optimise(design_problem& problem, const program_goal& goal, const Eigen::VectorXd& x,
                        const std::function<bool()>& stop = {}, int most_iterations = 500);

/// Equations whose gradients at x are independent of each other, as far as double precision tells.
std::vector<Eigen::Index> independent_equations(const Eigen::MatrixXd& jacobian);

}  // namespace apsis
