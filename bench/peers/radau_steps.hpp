#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Core>

namespace apsis::bench::peers {

struct radau_options {
  double rtol = 1e-6,
         atol = 1e-8;          ///< absolute tolerance for a System without absolute()
  long most_attempts = 40000;  ///< largest number of steps, including rejected ones
};

/// The Radau IIA method of order 5.
struct radau_tableau {
  Eigen::Vector3d abscissae;
  Eigen::Matrix3d weights;  ///< A
  double gamma0;            ///< inverse of the real eigenvalue of A⁻¹
  Eigen::Vector3d error;    ///< weights of the stages in the error estimate

  static const radau_tableau& get() {
    static const radau_tableau all = make();
    return all;
  }

 private:
  static radau_tableau make() {
    const double r = std::sqrt(6.0), gamma0 = (6.0 + std::cbrt(81.0) - std::cbrt(9.0)) / 30.0;
    return {
        {(4.0 - r) / 10.0, (4.0 + r) / 10.0, 1.0},
        Eigen::Matrix3d{{(88.0 - 7.0 * r) / 360.0, (296.0 - 169.0 * r) / 1800.0, (-2.0 + 3.0 * r) / 225.0},
                        {(296.0 + 169.0 * r) / 1800.0, (88.0 + 7.0 * r) / 360.0, (-2.0 - 3.0 * r) / 225.0},
                        {(16.0 - r) / 36.0, (16.0 + r) / 36.0, 1.0 / 9.0}},
        gamma0,
        gamma0 / 3.0 * Eigen::Vector3d(-13.0 - 7.0 * r, -13.0 + 7.0 * r, -1.0)};
  }
};

/// Integrates u' = F(t, u) by Radau IIA of order 5. The error estimate, the simplified Newton iteration, its
/// starting values and the predictive step control are those of RADAU5 (Hairer, Wanner, Solving Ordinary
/// Differential Equations II, section IV.8). With J = ∂F/∂u, a System has
///   vector, stages                types of u and of [Z₁, Z₂, Z₃], Z_i = Y_i − u
///   initial(), rate(t, u)         the initial u; F(t, u), NaN where it is undefined
///   absolute()                    atol of every unknown; not required
///   linearize(t, u), factorize(h)  computes J, and factorizes I − h A⊗J and I − hγ₀J
///   newton_change(D)              (I − h A⊗J)⁻¹ D
///   filtered(v)                   (I − hγ₀J)⁻¹ v
///   keeps_matrices                whether J and its factors are worth keeping, by the rules of RADAU5
template <class System>
class radau_steps {
 public:
  using vector = typename System::vector;
  using stages = typename System::stages;

  radau_steps(System& system, const radau_options& options) : system_(system), options_(options) {}

  /// Integrates from `begin` to `end`; observe(u) is called after each step and returns whether to continue.
  /// Returns whether the end was reached.
  template <class Observer>
  bool integrate(double begin, double end, const Observer& observe) {
    t_ = begin;
    start();
    long attempts = 0;
    while (t_ < end) {
      if (++attempts > options_.most_attempts || !(t_ + h_ > t_)) return false;
      next_ = end - t_ <= h_ ? end : t_ + h_;
      h_ = next_ == end ? end - t_ : h_;
      if (attempt() && !observe(u_)) return false;
    }
    return true;
  }

  const vector& value() const { return u_; }

 private:
  void start() {
    u_ = system_.initial();
    rate_ = system_.rate(t_, u_);
    h_ = 1e-6;
    taken_ = previous_error_ = factorized_ = 0.0;
    rejected_ = false;
    linearize();
  }

  void linearize() {
    system_.linearize(t_, u_);
    current_ = true;
    factorized_ = 0.0;
  }

  double norm(const vector& v) const {
    vector scale = options_.rtol * u_.cwiseAbs();
    if constexpr (requires(const System& of) { of.absolute(); })
      scale += system_.absolute();
    else
      scale.array() += options_.atol;
    return std::sqrt(v.cwiseQuotient(scale).squaredNorm() / static_cast<double>(v.size()));
  }

  /// Takes a step of length h_, or returns false with a smaller h_.
  bool attempt() {
    if (factorized_ != h_) system_.factorize(h_);
    factorized_ = h_;
    stages z = starting_values();
    const int iterations = solve(z);
    if (iterations < 0) return reject(0.5);
    const double error = std::max(estimate(z), 1e-10);
    constexpr double most = 10.0;
    const double safety = 0.9 * (2.0 * most + 1.0) / (2.0 * most + iterations);
    double factor = safety * std::pow(error, -0.25);
    if (!(error < 1.0)) return reject(std::isfinite(error) ? std::clamp(factor, 0.1, 1.0) : 0.1);
    if (previous_error_ > 0.0)
      factor = std::min(factor, safety * h_ / taken_ * std::pow(previous_error_ / (error * error), 0.25));
    t_ = next_;
    u_ += z.col(2);
    z_ = z;
    taken_ = h_;
    previous_error_ = std::max(error, 1e-2);
    rate_ = system_.rate(t_, u_);
    current_ = false;
    factor = std::clamp(factor, 0.2, rejected_ ? 1.0 : 8.0);
    rejected_ = false;
    const bool converges_fast = theta_ <= 1e-3;
    if (!System::keeps_matrices || !converges_fast) linearize();
    if (current_ || factor < 1.0 || factor > 1.2) h_ *= factor;
    return true;
  }

  bool reject(double factor) {
    h_ *= factor;
    rejected_ = true;
    if (!current_) linearize();
    return false;
  }

  /// Returns the collocation polynomial of the last step at the new stages.
  stages starting_values() const {
    const auto& c = radau_tableau::get().abscissae;
    if (!(taken_ > 0.0)) return stages::Zero(u_.size(), 3);
    const Eigen::Vector4d nodes(0.0, c[0], c[1], 1.0);
    stages z(u_.size(), 3);
    for (int i = 0; i < 3; ++i) {
      const double s = 1.0 + c[i] * h_ / taken_;
      z.col(i) = -z_.col(2);
      for (int j = 1; j < 4; ++j) {
        double basis = 1.0;
        for (int k = 0; k < 4; ++k)
          if (k != j) basis *= (s - nodes[k]) / (nodes[j] - nodes[k]);
        z.col(i) += basis * z_.col(j - 1);
      }
    }
    return z;
  }

  /// Solves Z = h A F(u + Z) by a simplified Newton iteration. Returns the number of iterations, −1
  /// without convergence.
  int solve(stages& z) {
    const auto& c = radau_tableau::get().abscissae;
    double before = 0.0;
    theta_ = 0.0;
    stages rates(u_.size(), 3);
    for (int k = 1; k <= 10; ++k) {
      for (int i = 0; i < 3; ++i) rates.col(i) = system_.rate(t_ + c[i] * h_, u_ + z.col(i));
      const stages change = system_.newton_change(h_ * rates * radau_tableau::get().weights.transpose() - z);
      z += change;
      double size = 0.0;
      for (int i = 0; i < 3; ++i) {
        const double of_stage = norm(change.col(i));
        if (!std::isfinite(of_stage)) return -1;
        size = std::max(size, of_stage);
      }
      if (size < 1e-10) return k;
      if (k > 1) {
        theta_ = size / before;
        if (!(theta_ < 0.99)) return -1;
        if (theta_ / (1.0 - theta_) * size <= newton_tolerance()) return k;
      }
      before = size;
    }
    return -1;
  }

  /// Returns the bound of RADAU5 for the iteration error relative to that of the step.
  double newton_tolerance() const {
    return std::max(10.0 * std::numeric_limits<double>::epsilon() / options_.rtol,
                    std::min(0.03, std::sqrt(options_.rtol)));
  }

  double estimate(const stages& z) {
    const auto& method = radau_tableau::get();
    const vector combined = z * method.error;
    vector error = system_.filtered(method.gamma0 * h_ * rate_ + combined);
    // After a rejection, and in the first step, the second solve makes the estimate bounded for h → ∞.
    if (norm(error) >= 1.0 && (rejected_ || !(taken_ > 0.0)))
      error = system_.filtered(method.gamma0 * h_ * system_.rate(t_, u_ + error) + combined);
    return norm(error);
  }

  System& system_;
  radau_options options_;
  vector u_, rate_;
  stages z_;
  double t_ = 0.0, next_ = 0.0;  ///< time of u_ and of the end of the step
  double h_ = 0.0, taken_ = 0.0, previous_error_ = 0.0;
  double factorized_ = 0.0;                 ///< h of the factors; 0 if the Jacobian has no factors yet
  double theta_ = 0.0;                      ///< convergence rate of the last Newton iteration
  bool rejected_ = false, current_ = true;  ///< current_: whether the Jacobian is that of u_
};

}  // namespace apsis::bench::peers
