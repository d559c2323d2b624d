#pragma once

#include <apsis/design/design_problem.hpp>

namespace apsis {

/// How a search for a point that satisfies the equations within the bounds ended.
struct feasibility_result {
  Eigen::VectorXd x;      ///< where it ended, within the bounds
  double residual = 0.0;  ///< largest |equation| there, and largest limit above 0
  bool feasible = false;  ///< residual below 1e-11
  int iterations = 0;     ///< steps that were taken or tried
};

/// Levenberg–Marquardt within bounds from x: each step is the smallest change that satisfies the linearised
/// equations (damped), where unknowns that would leave their bounds are put on them and the step is computed
/// again for the others. Ends when the equations hold, or when they no longer come nearer.
feasibility_result find_feasible(design_problem& problem, Eigen::VectorXd x, int most_iterations = 300);

}  // namespace apsis
