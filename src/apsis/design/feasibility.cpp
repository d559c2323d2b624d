#include <apsis/design/feasibility.hpp>

#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

namespace apsis {
namespace {

/// Damped steps Jᵀ (J Jᵀ + damping)⁻¹ (−c) of the free unknowns. Unknowns that would cross a bound are fixed
/// on it, and their columns are removed from J Jᵀ.
class bounded_steps {
 public:
  bounded_steps(const design_problem& problem, const Eigen::VectorXd& x, Eigen::MatrixXd jacobian,
                Eigen::VectorXd c)
      : J_(std::move(jacobian)),
        c_(std::move(c)),
        to_lower_(problem.lower() - x),
        to_upper_(problem.upper() - x) {
    normal_.setZero(J_.rows(), J_.rows());
    normal_.selfadjointView<Eigen::Lower>().rankUpdate(J_);
  }

  Eigen::VectorXd step(double damping) const {
    Eigen::MatrixXd normal = normal_;
    normal.diagonal().array() += damping;
    Eigen::VectorXd rest = -c_, step = Eigen::VectorXd::Zero(J_.cols());
    std::vector<char> fixed(static_cast<std::size_t>(J_.cols()), 0);
    for (int round = 0; round < most_rounds; ++round) {
      const Eigen::VectorXd proposal =
          J_.transpose() * normal.selfadjointView<Eigen::Lower>().ldlt().solve(rest);
      std::vector<Eigen::Index> crossed;
      for (Eigen::Index k = 0; k < step.size(); ++k) {
        if (fixed[static_cast<std::size_t>(k)] != 0) continue;
        step(k) = std::min(std::max(proposal(k), to_lower_(k)), to_upper_(k));
        if (step(k) == proposal(k)) continue;
        fixed[static_cast<std::size_t>(k)] = 1;
        crossed.push_back(k);
      }
      if (crossed.empty()) break;
      const Eigen::MatrixXd columns = J_(Eigen::all, crossed);
      rest -= columns * step(crossed);
      normal.selfadjointView<Eigen::Lower>().rankUpdate(columns, -1.0);
    }
    return step;
  }

 private:
  static constexpr int most_rounds = 8;
  Eigen::MatrixXd J_, normal_;
  Eigen::VectorXd c_, to_lower_, to_upper_;
};

/// Returns the residuals of the equations, followed by violated limits.
Eigen::VectorXd violations(design_problem& problem, const Eigen::VectorXd& x) {
  Eigen::VectorXd c = problem.residuals(x);
  if (problem.limits() == 0) return c;
  const auto equations = c.size();
  c.conservativeResize(equations + problem.limits());
  c.tail(problem.limits()) = problem.limit_values(x).cwiseMax(0.0);
  return c;
}

Eigen::MatrixXd violation_jacobian(design_problem& problem, const Eigen::VectorXd& x,
                                   const Eigen::VectorXd& c) {
  Eigen::MatrixXd J = problem.jacobian(x);
  if (problem.limits() == 0) return J;
  const auto equations = J.rows();
  J.conservativeResize(c.size(), Eigen::NoChange);
  J.bottomRows(problem.limits()) = problem.limit_jacobian(x);
  for (Eigen::Index k = equations; k < c.size(); ++k)
    if (c(k) == 0.0) J.row(k).setZero();
  return J;
}

}  // namespace

feasibility_result search_feasible(design_problem& problem, Eigen::VectorXd x, int most_iterations) {
  constexpr double enough = 1e-11, exact = 1e-14;
  feasibility_result result;
  x = x.cwiseMax(problem.lower()).cwiseMin(problem.upper());
  Eigen::VectorXd c = violations(problem, x);
  double damping = 1e-2, slowest = c.norm();
  for (; result.iterations < most_iterations && c.lpNorm<Eigen::Infinity>() > exact; ++result.iterations) {
    // Require a reduction by a tenth in 25 iterations.
    if (result.iterations % 25 == 24) {
      if (c.norm() > 0.9 * slowest) break;
      slowest = c.norm();
    }
    const bounded_steps steps(problem, x, violation_jacobian(problem, x, c), c);
    bool moved = false;
    for (int attempt = 0; attempt < 12 && !moved; ++attempt) {
      // Project again: x + (bound − x) may differ from the bound by rounding.
      const Eigen::VectorXd trial =
          (x + steps.step(damping * c.squaredNorm())).cwiseMax(problem.lower()).cwiseMin(problem.upper());
      const Eigen::VectorXd there = violations(problem, trial);
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
