#include <apsis/design/feasibility.hpp>

#include <cmath>

#include <Eigen/Cholesky>

namespace apsis {
namespace {

/// The damped step for the unknowns that are free; those that would cross a bound go onto it.
Eigen::VectorXd bounded_step(const Eigen::MatrixXd& J, const Eigen::VectorXd& c, const Eigen::VectorXd& x,
                             const design_problem& problem, double damping) {
  const Eigen::Index n = x.size();
  const Eigen::VectorXd to_lower = problem.lower() - x, to_upper = problem.upper() - x;
  Eigen::VectorXd step = Eigen::VectorXd::Zero(n), free = Eigen::VectorXd::Ones(n);
  for (int round = 0; round < 8; ++round) {
    // The smallest step of the free unknowns: Jᵀ (J Jᵀ + damping)⁻¹ of what the fixed ones leave.
    const Eigen::MatrixXd J_free = J * free.asDiagonal();
    Eigen::MatrixXd normal = J_free * J_free.transpose();
    normal.diagonal().array() += damping;
    const Eigen::VectorXd fixed = step.cwiseProduct(Eigen::VectorXd::Ones(n) - free);
    const Eigen::VectorXd rest = -c - J * fixed;
    const Eigen::VectorXd proposal = J_free.transpose() * normal.ldlt().solve(rest);
    step = fixed + proposal;
    bool crossed = false;
    for (Eigen::Index k = 0; k < n; ++k) {
      if (free(k) == 0.0 || (step(k) >= to_lower(k) && step(k) <= to_upper(k))) continue;
      step(k) = step(k) < to_lower(k) ? to_lower(k) : to_upper(k);
      free(k) = 0.0;
      crossed = true;
    }
    if (!crossed) break;
  }
  return step.cwiseMax(to_lower).cwiseMin(to_upper);
}

}  // namespace

feasibility_result find_feasible(design_problem& problem, Eigen::VectorXd x, int most_iterations) {
  constexpr double enough = 1e-11, exact = 1e-14;
  feasibility_result result;
  x = x.cwiseMax(problem.lower()).cwiseMin(problem.upper());
  Eigen::VectorXd c = problem.residuals(x);
  double damping = 1e-2, slowest = c.norm();
  for (; result.iterations < most_iterations && c.lpNorm<Eigen::Infinity>() > exact; ++result.iterations) {
    // Once in 25 iterations it must have come a tenth nearer.
    if (result.iterations % 25 == 24) {
      if (c.norm() > 0.9 * slowest) break;
      slowest = c.norm();
    }
    const Eigen::MatrixXd J = problem.jacobian(x);
    bool moved = false;
    for (int attempt = 0; attempt < 12 && !moved; ++attempt) {
      const Eigen::VectorXd trial = x + bounded_step(J, c, x, problem, damping * c.squaredNorm());
      const Eigen::VectorXd there = problem.residuals(trial);
      if (there.allFinite() && there.squaredNorm() < c.squaredNorm()) {
        damping = std::max(damping / 5.0, 1e-12);
        x = trial;
        c = there;
        moved = true;
      } else {
        damping = std::max(damping * 6.0, 1e-10);
      }
    }
    if (!moved) break;
  }
  result.x = x;
  result.residual = c.lpNorm<Eigen::Infinity>();
  result.feasible = result.residual <= enough;
  return result;
}

}  // namespace apsis
