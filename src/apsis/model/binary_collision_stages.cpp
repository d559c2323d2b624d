#include <apsis/model/internal/binary_collision_stages.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/relaxation_weights.hpp>
#include <apsis/integrate/unsquared_newton.hpp>
#include <apsis/model/model.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Dense>

namespace apsis {
namespace {

/// The weights w₀, w₁/ν and w₂/ν² of the stage equation (internal/binary_collision_stages.hpp).
struct stage_weights {
  double zeroth, first, second;
};

/// The stage equation in the coordinates y = Bᵀv of the reachable directions: v = u + B(y − Bᵀu).
class reachable_stage final : public stage_equation<double> {
 public:
  reachable_stage(const binary_collisions& collisions, const Eigen::VectorXd& u, double a, double b)
      : collisions_(collisions),
        u_(u),
        a_(a),
        b_(b),
        start_(collisions.reachable().transpose() * u),
        change_(u.size()) {}

  std::size_t size() const override { return static_cast<std::size_t>(start_.size()); }
  stage_terms<double> terms() const override {
    return {a_, b_, {start_.data(), size()}, u_.lpNorm<Eigen::Infinity>()};
  }
  bool admissible(std::span<const double>) override { return true; }
  void rate(std::span<const double> y, std::span<double> g) override {
    collisions_.change(state(y).data(), change_.data());
    vector(g).noalias() = collisions_.reachable().transpose() * change_;
  }
  void rate_product(std::span<const double> y, std::span<const double> x, std::span<double> jx) override {
    vector(jx).noalias() = derivative_at(y) * vector(x);
  }
  void rate_curvature(std::span<const double> y, std::span<const double> k, std::span<const double> x,
                      std::span<double> jx, std::span<double> hx) override {
    rate_product(y, x, jx);
    // Q is quadratic: Q''[k, x] = Q'(k) x.
    if (!of_rate_.is_at(k)) collisions_.derivative(lifted(k).data(), scratch_, of_rate_.move_to(k));
    vector(hx).noalias() = of_rate_.matrix * vector(x);
  }
  // Only unsquared_newton() solves this equation; it calls neither of these functions.
  void residual(std::span<const double>, std::span<double>) override {}
  void differential(std::span<const double>, std::span<const double>, std::span<double>,
                    std::span<double>) override {}

  /// Returns the state of the coordinates y.
  Eigen::VectorXd state(std::span<const double> y) const {
    return u_ + collisions_.reachable() * (vector(y) - start_);
  }

 private:
  /// A matrix that depends on a point, with the point of its last evaluation.
  struct remembered {
    std::vector<double> point;
    Eigen::MatrixXd matrix;
    bool is_at(std::span<const double> y) const {
      return std::equal(y.begin(), y.end(), point.begin(), point.end());
    }
    Eigen::MatrixXd& move_to(std::span<const double> y) {
      point.assign(y.begin(), y.end());
      return matrix;
    }
  };

  static Eigen::Map<const Eigen::VectorXd> vector(std::span<const double> x) {
    return {x.data(), static_cast<Eigen::Index>(x.size())};
  }
  static Eigen::Map<Eigen::VectorXd> vector(std::span<double> x) {
    return {x.data(), static_cast<Eigen::Index>(x.size())};
  }
  Eigen::VectorXd lifted(std::span<const double> k) const { return collisions_.reachable() * vector(k); }
  const Eigen::MatrixXd& derivative_at(std::span<const double> y) {
    if (!of_state_.is_at(y)) collisions_.derivative(state(y).data(), scratch_, of_state_.move_to(y));
    return of_state_.matrix;
  }

  const binary_collisions& collisions_;
  const Eigen::VectorXd& u_;
  double a_, b_;
  Eigen::VectorXd start_, change_;
  remembered of_state_, of_rate_;
  Eigen::MatrixXd scratch_;
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
      const double share = coefficients_of_stage(a, b, frequency, at.epsilon[p]).weight_of_b;
      const stage_weights of = {weights.of_u, weights.of_e * (1.0 - share) / frequency,
                                weights.of_e * share / frequency / frequency};
      const bool found = solve(of, weights.of_e);
      if (loses_directions_) {
        solve_unsquared(found, a / at.epsilon[p], b / (at.epsilon[p] * at.epsilon[p]), p, at);
      } else if (!found) {
        fail(weights.of_u == 0.0 ? "there is no equilibrium with these moments"
                                 : "Newton's method does not converge",
             p, at);
      }
      // Without Q̇ the exact solution is nonnegative; this step makes the computed one nonnegative too.
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

  /// v_ ← the solution of a stage whose slow directions are lost in the rounding errors of squares. Starts
  /// from v_ if `found`, else from u.
  void solve_unsquared(bool found, double a, double b, int p, const point_batch& at) {
    reachable_stage equation(collisions_, u_, a, b);
    if (!found) v_ = u_;
    Eigen::VectorXd y = basis_.transpose() * v_;
    const std::span<double> out(y.data(), static_cast<std::size_t>(y.size()));
    try {
      unsquared_newton<double>(equation, out, {});
    } catch (const numerical_error& failure) {
      failure_site site = failure.site();
      site.cell = at.first_cell + p / at.points_per_cell;
      throw numerical_error(failure.problem(), site);
    }
    v_ = equation.state(out);
  }

  /// v_ ← the solution of the stage. If collisions are few, Newton's method starts at u. If that fails, or
  /// with more collisions, it starts at the solution of a relaxation with the same equilibrium, then at the
  /// equilibrium, then at u. Returns false if all starts fail.
  bool solve(const stage_weights& of, double weight_of_e) {
    constexpr double few = 0.2;
    loses_directions_ = false;
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

  /// residual_ ← the left-hand side of the stage equation at ξ. Also stores v_, change_, projected_ and k_
  /// for its derivative.
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
    constexpr double smallest_part = 1e-8, quadratic = 1e-9, smallest_rcond = 1e-8;
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(basis_.cols(), basis_.cols());
    evaluate_at(of, xi);
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      Eigen::MatrixXd slope = of.zeroth * identity - of.first * k_;
      if (of.second > 0.0) {
        collisions_.derivative(change_.data(), scratch_, along_);
        slope += of.second * (k_ * k_ + along_);
      }
      const Eigen::PartialPivLU<Eigen::MatrixXd> lu(slope);
      // At ε = 0 every direction is fast.
      loses_directions_ = of.second > 0.0 && of.zeroth > 0.0 && lu.rcond() < smallest_rcond;
      const Eigen::VectorXd step = -lu.solve(residual_);
      if (!step.allFinite()) return false;
      const double length = step.lpNorm<Eigen::Infinity>();
      if (length <= quadratic * u_.lpNorm<Eigen::Infinity>()) {
        // One more step with the same derivative has an error of the size of the product of the last
        // two steps.
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
  bool loses_directions_ = false;  ///< whether the matrix of the last solve was singular to rounding
};

}  // namespace

std::unique_ptr<point_collision> make_binary_collision(const binary_collisions& collisions) {
  return std::make_unique<binary_collision_solver>(collisions);
}

}  // namespace apsis
