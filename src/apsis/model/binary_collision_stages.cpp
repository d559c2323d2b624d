#include <apsis/model/internal/binary_collision_stages.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/relaxation_weights.hpp>
#include <apsis/model/model.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

namespace apsis {
namespace {

/// w₀, w₁/ν, w₂/ν² of the equation of a stage.
struct stage_weights {
  double zeroth, first, second;
};

class binary_collision_solver final : public point_collision {
 public:
  explicit binary_collision_solver(const binary_collisions& collisions)
      : collisions_(collisions),
        n_(collisions.size()),
        basis_(collisions.reachable()),
        u_(n_),
        v_(n_),
        change_(n_) {}

  void solve_stage(double a, double b, const point_batch& at, double* u) override {
    for (int p = 0; p < at.count; ++p) {
      double* row = u + p * at.pitch;
      u_ = Eigen::Map<const Eigen::VectorXd>(row, n_);
      const double frequency = collisions_.frequency(row);
      if (!std::isfinite(frequency)) fail("a density is not finite", p, at);
      const auto weights = relax_weights(a, b, frequency, at.epsilon[p]);
      if (weights.of_e == 0.0) continue;
      const double share = strength_of_stage(a, b, frequency, at.epsilon[p]).share;
      const stage_weights of = {weights.of_u, weights.of_e * (1.0 - share) / frequency,
                                weights.of_e * share / frequency / frequency};
      if (!solve(of, weights.of_e))
        fail(weights.of_u == 0.0 ? "there is no equilibrium with these moments"
                                 : "Newton's method does not converge",
             p, at);
      // Without Q̇ the solution is nonnegative, and so are its roundings.
      if (share == 0.0 && weights.of_u > 0.0)
        collisions_.gain_over_loss(u_.data(), of.first / of.zeroth, v_.data());
      std::copy_n(v_.data(), n_, row);
    }
  }

  void evaluate(const point_batch& at, const double* u, double* q) override {
    for (int p = 0; p < at.count; ++p) {
      if (!(at.epsilon[p] > 0.0))
        throw numerical_error(
            "Q/epsilon does not exist for epsilon = 0 (the method evaluates it explicitly); choose an "
            "implicit or "
            "IMEX method",
            {-1, std::nan(""), at.first_cell + p / at.points_per_cell, at.epsilon[p]});
      double* row = q + p * at.pitch;
      collisions_.change(u + p * at.pitch, row);
      for (int k = 0; k < n_; ++k) row[k] /= at.epsilon[p];
    }
  }

  double forward_euler_step(const double* u, double epsilon) override {
    return epsilon / collisions_.frequency(u);
  }
  double relaxation_time(const double* u, double epsilon) override {
    const double thickness = epsilon / collisions_.frequency(u);
    return thickness > 0.0 ? thickness : std::numeric_limits<double>::infinity();
  }

 private:
  [[noreturn]] static void fail(const char* why, int p, const point_batch& at) {
    throw numerical_error(
        std::string("a collision of discrete velocities cannot be solved (") + why +
            "); use a smaller step, or a method of lower order whose stages keep densities nonnegative",
        {-1, std::nan(""), at.first_cell + p / at.points_per_cell, at.epsilon[p]});
  }

  /// v_ ← the solution of the stage. Newton's method starts at u where collisions are few, else at the
  /// solution of a relaxation with the same equilibrium, then at the equilibrium and at u.
  bool solve(const stage_weights& of, double weight_of_e) {
    constexpr double few = 0.2;
    const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(basis_.cols());
    if (weight_of_e < few && newton(of, nothing)) return true;
    Eigen::VectorXd e(n_);
    const bool has_equilibrium = collisions_.minimize_entropy(collisions_.moments(u_.data()), e.data());
    if (of.zeroth == 0.0) {
      v_ = e;
      return has_equilibrium;
    }
    if (has_equilibrium) {
      const Eigen::VectorXd away = basis_.transpose() * (e - u_);
      for (const double part : {weight_of_e, 1.0})
        if (newton(of, part * away)) return true;
    }
    return newton(of, nothing);
  }

  /// residual ← the left-hand side of the equation at ξ, and what its derivative needs.
  void evaluate_at(const stage_weights& of, const Eigen::VectorXd& xi) {
    v_.noalias() = u_ + basis_ * xi;
    collisions_.change(v_.data(), change_.data());
    projected_.noalias() = basis_.transpose() * change_;
    collisions_.derivative(v_.data(), scratch_, k_);
    residual_ = of.zeroth * xi - of.first * projected_;
    if (of.second > 0.0) residual_ += of.second * (k_ * projected_);
  }

  bool newton(const stage_weights& of, Eigen::VectorXd xi) {
    constexpr int most_iterations = 60;
    constexpr double smallest_part = 1e-8, quadratic = 1e-9;
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(basis_.cols(), basis_.cols());
    evaluate_at(of, xi);
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      Eigen::MatrixXd slope = of.zeroth * identity - of.first * k_;
      if (of.second > 0.0) {
        collisions_.derivative(change_.data(), scratch_, along_);
        slope += of.second * (k_ * k_ + along_);
      }
      const Eigen::PartialPivLU<Eigen::MatrixXd> lu(slope);
      const Eigen::VectorXd step = -lu.solve(residual_);
      if (!step.allFinite()) return false;
      const double length = step.lpNorm<Eigen::Infinity>();
      if (length <= quadratic * u_.lpNorm<Eigen::Infinity>()) {
        // One more step with the same derivative: its error is of the size of the product of the last two.
        evaluate_at(of, xi + step);
        v_.noalias() = u_ + basis_ * (xi + step - lu.solve(residual_));
        return v_.allFinite();
      }
      // The natural monotonicity test: the next step with the same derivative must be shorter (Deuflhard,
      // Newton Methods for Nonlinear Problems, section 3.3).
      double part = 1.0;
      for (; part > smallest_part; part *= 0.5) {
        evaluate_at(of, xi + part * step);
        if (lu.solve(residual_).lpNorm<Eigen::Infinity>() <= (1.0 - 0.5 * part) * length) break;
      }
      if (!(part > smallest_part)) return false;
      xi += part * step;
    }
    return false;
  }

  const binary_collisions& collisions_;
  int n_;
  const Eigen::MatrixXd& basis_;
  Eigen::VectorXd u_, v_, change_, projected_, residual_;
  Eigen::MatrixXd k_, along_, scratch_;
};

}  // namespace

std::unique_ptr<point_collision> make_binary_collision(const binary_collisions& collisions) {
  return std::make_unique<binary_collision_solver>(collisions);
}

}  // namespace apsis
