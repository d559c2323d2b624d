#pragma once

#include <apsis/design/design_problem.hpp>

namespace apsis {

/// Result of search_feasible().
struct feasibility_result {
  Eigen::VectorXd x;      ///< final point, within the bounds
  double residual = 0.0;  ///< largest |residual| or violated limit at x
  bool feasible = false;  ///< whether the residual is at most 1e-11
  int iterations = 0;     ///< number of iterations
};

/// Searches for a point that satisfies equations and bounds by a projected Levenberg–Marquardt method from x.
/// Each step is the smallest damped change that satisfies the linearized equations. Unknowns that would leave
/// their bounds are fixed there, and the step is recomputed for the others. Stops when the equations hold or
/// convergence stalls.
feasibility_result search_feasible(design_problem& problem, Eigen::VectorXd x, int most_iterations = 300);

}  // namespace apsis
