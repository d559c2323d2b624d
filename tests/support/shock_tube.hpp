#pragma once

#include <cmath>

namespace test_support {

/// Exact solution of the Riemann problem of a perfect gas at rest on both sides. It has a rarefaction to the
/// left and a shock to the right. Bisection gives the pressure between them (Toro, Riemann Solvers, 2009,
/// chapter 4).
class shock_tube {
 public:
  shock_tube(double gamma, double rho_left, double p_left, double rho_right, double p_right)
      : g_(gamma), rho_{rho_left, rho_right}, p_{p_left, p_right} {
    double low = p_right, high = p_left;
    for (int k = 0; k < 100; ++k) {
      middle_ = 0.5 * (low + high);
      (velocity_left(middle_) > velocity_right(middle_) ? low : high) = middle_;
    }
  }

  /// Return pressure and velocity between rarefaction and shock.
  double pressure() const { return middle_; }
  double velocity() const { return velocity_left(middle_); }
  /// Return the density on either side of the contact.
  double density_left() const { return rho_[0] * std::pow(middle_ / p_[0], 1.0 / g_); }
  double density_right() const {
    const double ratio = middle_ / p_[1], b = (g_ - 1.0) / (g_ + 1.0);
    return rho_[1] * (ratio + b) / (b * ratio + 1.0);
  }

  double density(double xi) const {  // xi = x/t
    const double c = std::sqrt(g_ * p_[0] / rho_[0]), c_behind = c * std::pow(middle_ / p_[0], half());
    if (xi < -c) return rho_[0];
    if (xi < velocity() - c_behind)
      return rho_[0] * std::pow(2.0 / (g_ + 1.0) - (g_ - 1.0) / (g_ + 1.0) * xi / c, 2.0 / (g_ - 1.0));
    if (xi < velocity()) return density_left();
    const double speed =
        std::sqrt(g_ * p_[1] / rho_[1] * ((g_ + 1.0) / (2.0 * g_) * middle_ / p_[1] + half()));
    return xi < speed ? density_right() : rho_[1];
  }

 private:
  double half() const { return (g_ - 1.0) / (2.0 * g_); }
  double velocity_left(double p) const {
    return 2.0 / (g_ - 1.0) * std::sqrt(g_ * p_[0] / rho_[0]) * (1.0 - std::pow(p / p_[0], half()));
  }
  double velocity_right(double p) const {
    const double a = 2.0 / ((g_ + 1.0) * rho_[1]), b = (g_ - 1.0) / (g_ + 1.0) * p_[1];
    return (p - p_[1]) * std::sqrt(a / (p + b));
  }

  double g_, rho_[2], p_[2], middle_ = 0.0;
};

}  // namespace test_support
