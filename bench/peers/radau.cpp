#include "radau.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace apsis::bench::peers {
namespace {

using vector2 = Eigen::Vector2d;
using matrix2 = Eigen::Matrix2d;
using matrix6 = Eigen::Matrix<double, 6, 6>;
using stages = Eigen::Matrix<double, 2, 3>;  ///< Z_i = Y_i − u, one column for each stage

const double root6 = std::sqrt(6.0);
const Eigen::Vector3d abscissae((4.0 - root6) / 10.0, (4.0 + root6) / 10.0, 1.0);
const Eigen::Matrix3d weights{
    {(88.0 - 7.0 * root6) / 360.0, (296.0 - 169.0 * root6) / 1800.0, (-2.0 + 3.0 * root6) / 225.0},
    {(296.0 + 169.0 * root6) / 1800.0, (88.0 + 7.0 * root6) / 360.0, (-2.0 - 3.0 * root6) / 225.0},
    {(16.0 - root6) / 36.0, (16.0 + root6) / 36.0, 1.0 / 9.0}};
/// γ₀, the inverse of the real eigenvalue of A⁻¹.
const double gamma0 = (6.0 + std::cbrt(81.0) - std::cbrt(9.0)) / 30.0;
const Eigen::Vector3d error_weights =
    gamma0 / 3.0 * Eigen::Vector3d(-13.0 - 7.0 * root6, -13.0 + 7.0 * root6, -1.0);

class radau {
 public:
  radau(const stiff_task& task, const radau_options& options) : task_(task), options_(options) {}

  /// Integrates from t = 0 to 1; observe(u) is called after each step. Returns false if that takes too many
  /// steps.
  template <class Observer>
  bool integrate(const Observer& observe) {
    constexpr long most_attempts = 40000;
    start();
    long attempts = 0;
    for (double t = 0.0; t < 1.0;) {
      if (++attempts > most_attempts) return false;
      const bool last = 1.0 - t <= h_;
      if (last) h_ = 1.0 - t;
      if (!attempt()) continue;
      t = last ? 1.0 : t + taken_;
      observe(u_);
    }
    return true;
  }

  stiff_task::state value() const { return {u_[0], u_[1]}; }

 private:
  void start() {
    const auto u = task_.initial();
    u_ = {u[0], u[1]};
    h_ = 1e-6;
    taken_ = 0.0;
    previous_error_ = 0.0;
    rejected_ = false;
    fresh_ = true;
  }

  vector2 rate(const vector2& u) const {
    const stiff_task::state at{u[0], u[1]};
    const auto slow = task_.transport(at), fast = task_.collision(at);
    return {slow[0] + fast[0], slow[1] + fast[1]};
  }

  double norm(const vector2& v) const {
    const vector2 scale = (options_.atol + options_.rtol * u_.array().abs()).matrix();
    return std::sqrt(v.cwiseQuotient(scale).squaredNorm() / 2.0);
  }

  /// Takes a step of length h_, or returns false with a smaller h_.
  bool attempt() {
    const stiff_task::state at{u_[0], u_[1]};
    if (fresh_) {
      jacobian_ = task_.transport_jacobian(at) + task_.collision_jacobian(at);
      rate_ = rate(u_);
      fresh_ = false;
    }
    stages z = starting_values();
    const int iterations = solve(z);
    if (iterations < 0) {
      h_ *= 0.5;
      rejected_ = true;
      return false;
    }
    const double error = std::max(estimate(z), 1e-10);
    constexpr double most = 10.0;
    const double safety = 0.9 * (2.0 * most + 1.0) / (2.0 * most + iterations);
    double factor = safety * std::pow(error, -0.25);
    if (!(error < 1.0)) {
      h_ *= std::isfinite(error) ? std::clamp(factor, 0.1, 1.0) : 0.1;
      rejected_ = true;
      return false;
    }
    if (previous_error_ > 0.0)
      factor = std::min(factor, safety * h_ / taken_ * std::pow(previous_error_ / (error * error), 0.25));
    u_ += z.col(2);
    z_ = z;
    taken_ = h_;
    previous_error_ = std::max(error, 1e-2);
    h_ *= std::clamp(factor, 0.2, rejected_ ? 1.0 : 8.0);
    rejected_ = false;
    fresh_ = true;
    return true;
  }

  /// Returns the collocation polynomial of the last step at the new stages.
  stages starting_values() const {
    if (!(taken_ > 0.0)) return stages::Zero();
    const Eigen::Vector4d nodes(0.0, abscissae[0], abscissae[1], 1.0);
    stages z;
    for (int i = 0; i < 3; ++i) {
      const double s = 1.0 + abscissae[i] * h_ / taken_;
      vector2 value = -z_.col(2);
      for (int j = 1; j < 4; ++j) {
        double basis = 1.0;
        for (int k = 0; k < 4; ++k)
          if (k != j) basis *= (s - nodes[k]) / (nodes[j] - nodes[k]);
        value += basis * z_.col(j - 1);
      }
      z.col(i) = value;
    }
    return z;
  }

  /// Simplified Newton iteration for Z = h A F(u + Z); returns the number of iterations, −1 without
  /// convergence.
  int solve(stages& z) const {
    matrix6 system = matrix6::Identity();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) system.block<2, 2>(2 * i, 2 * j) -= h_ * weights(i, j) * jacobian_;
    const Eigen::PartialPivLU<matrix6> factors(system);
    double before = 0.0;
    for (int k = 1; k <= 10; ++k) {
      stages rates;
      for (int i = 0; i < 3; ++i) rates.col(i) = rate(u_ + z.col(i));
      const stages defect = h_ * rates * weights.transpose() - z;
      const Eigen::Matrix<double, 6, 1> right = defect.reshaped(), change = factors.solve(right);
      z += change.reshaped(2, 3);
      double size = 0.0;
      for (int i = 0; i < 3; ++i) size = std::max(size, norm(change.segment<2>(2 * i)));
      if (!std::isfinite(size)) return -1;
      if (size < 1e-10) return k;
      if (k > 1) {
        const double theta = size / before;
        if (!(theta < 0.99)) return -1;
        if (theta / (1.0 - theta) * size <= newton_tolerance()) return k;
      }
      before = size;
    }
    return -1;
  }

  /// As RADAU5: the iteration error relative to that of the step.
  double newton_tolerance() const {
    return std::max(10.0 * std::numeric_limits<double>::epsilon() / options_.rtol,
                    std::min(0.03, std::sqrt(options_.rtol)));
  }

  double estimate(const stages& z) const {
    const Eigen::PartialPivLU<matrix2> factors(matrix2::Identity() - h_ * gamma0 * jacobian_);
    const vector2 combined = z * error_weights;
    vector2 error = factors.solve(gamma0 * h_ * rate_ + combined);
    // After a rejection, and in the first step, the second solve makes the estimate bounded for h → ∞.
    if (norm(error) >= 1.0 && (rejected_ || !(taken_ > 0.0)))
      error = factors.solve(gamma0 * h_ * rate(u_ + error) + combined);
    return norm(error);
  }

  const stiff_task& task_;
  radau_options options_;
  vector2 u_, rate_;
  matrix2 jacobian_;
  stages z_;
  double h_ = 0.0, taken_ = 0.0, previous_error_ = 0.0;
  bool rejected_ = false, fresh_ = true;
};

}  // namespace

outcome run_radau(const stiff_task& task, const radau_options& options) {
  radau run(task, options);
  outcome measured;
  measured.smallest = std::numeric_limits<double>::infinity();
  const bool done = run.integrate([&](const vector2& u) {
    measured.smallest = std::min({measured.smallest, u[0], u[1]});
    ++measured.steps;
  });
  if (!done) {
    measured.failure = "failed";
    return measured;
  }
  measured.seconds = seconds_per_call([&] { run.integrate([](const vector2&) {}); });
  measured.error = task.error(run.value());
  measured.smallest_final = std::min(run.value()[0], run.value()[1]);
  return measured;
}

}  // namespace apsis::bench::peers
