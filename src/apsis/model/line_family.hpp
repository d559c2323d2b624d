#pragma once

#include <apsis/exec/aligned.hpp>
#include <apsis/velocity/velocity_line.hpp>

#include <cmath>
#include <limits>

namespace apsis {

/// Stopping criterion of Newton's method for an equation between logarithms of sums.
class newton_end {
 public:
  /// Returns whether to stop. Call it before every step with the absolute residual.
  bool reached(double residual) {
    close_ = previous_ < quadratic && residual < quadratic;
    const bool at_rounding = close_ && (residual < rounding || !(residual < 0.5 * previous_));
    previous_ = residual;
    return residual <= enough || at_rounding;
  }
  /// Whether the last two residuals were so small that the last one may be rounding.
  bool close() const { return close_; }
  /// Returns the last residual.
  double previous() const { return previous_; }

 private:
  /// Rounding of a sum of a few terms. Iterations end at such a residual.
  static constexpr double enough = 4.0 * std::numeric_limits<double>::epsilon();
  /// Rounding of a sum over a line and its exponents. Larger residuals are reduced further.
  static constexpr double rounding = 1e-14;
  static constexpr double quadratic = 1e-8;
  double previous_ = std::numeric_limits<double>::infinity();
  bool close_ = false;
};

/// The weights w_j = b_j exp(β x_j − τ C_j) on one direction of a velocity grid. Here b_j is the weight of
/// the quadrature, or 1 on a uniform grid. x_j is the distance from the prescribed mean in units of the
/// spacing. C_j ≥ 0 is a parabola with zeros at two grid points: the neighbours of the mean (`nearest`), or
/// the ends of the grid (`farthest`).
///
/// Every discrete Maxwellian is a product of such weights. For τ → ∞ only the two points remain, which is the
/// limit on the boundary of the realizable moments. Sums of C_j and of one-sided x_j have terms of one sign.
/// They do not cancel, however close the boundary is.
class line_family {
 public:
  /// The two grid points with C_j = 0.
  enum class face {
    nearest,  ///< the neighbours of the mean
    farthest  ///< the ends of the grid
  };

  /// Sums over all points of the line.
  struct sums {
    double mass = 0.0,  ///< Σ w
        above = 0.0,    ///< Σ w max(x, 0)
        below = 0.0,    ///< Σ w max(−x, 0)
        energy = 0.0;   ///< Σ w C / Σ w

    /// Returns log(above/below). It vanishes if the mean is the prescribed one.
    double imbalance() const { return log_of_ratio(above, below); }
  };
  /// Derivatives of imbalance() and of the energy. imbalance_by_beta is at least 1.
  struct slopes {
    double imbalance_by_beta = 0.0,  ///< ∂ imbalance/∂β
        imbalance_by_tau = 0.0,      ///< ∂ imbalance/∂τ
        energy_by_beta = 0.0,        ///< ∂ energy/∂β
        energy_by_tau = 0.0;         ///< ∂ energy/∂τ
  };
  /// Returns log(x/y), accurate to rounding even for x ≈ y.
  static double log_of_ratio(double x, double y) {
    const double more = (x - y) / y;
    return std::abs(more) < 1e-6 ? more * (1.0 - 0.5 * more) : std::log(x / y);
  }

  /// Sets the line, with b from its weights if `weighted` and b = 1 otherwise. The mean lies between the
  /// ends, at `offset` from its nearest point.
  void attach(const velocity_line& line, bool weighted, int nearest_point, double offset, face at);
  /// Returns the β of exp(−τ x²), a Gaussian about the mean.
  double beta_of_gaussian(double tau) const { return tau * (2.0 * offset_ - ends_); }
  /// Returns the square of the distance of the two points with C = 0.
  double gap_square() const { return (from_right_ + mean_) * (from_right_ + mean_); }
  /// Whether the mean is an end of the grid. All mass is then at this end, for any β and τ.
  bool fixed() const { return fixed_; }

  /// Returns the sums at (β, τ). The weights are scaled such that they and their products over directions are
  /// finite. Weights below 1e−300 become 0.
  sums evaluate(double beta, double tau);
  /// Returns the slopes at the last evaluate(), whose result is `s`.
  slopes differentiate(const sums& s) const;
  /// Solves for the β at which the mean is the prescribed one, for given τ and starting from `beta`. Returns
  /// the sums there.
  sums solve(double tau, double& beta);
  /// Sets the weights of the limit τ → ∞ with the prescribed mean. Returns their sum, 1.
  double take_limit();
  /// Returns w_j/b_j of the last evaluate(), solve() or take_limit().
  const double* values();

 private:
  sums sums_of(double beta, double tau, double shift);
  double largest_exponent(double beta, double tau) const;

  const velocity_line* line_ = nullptr;
  bool weighted_ = false;
  int n_ = 0, padded_ = 0, left_ = 0, right_ = 0;  // zeros of C
  int nearest_ = 0;
  double offset_ = 0.0, ends_ = 0.0;      // sum of the distances of the zeros from nearest_
  double mean_ = 0.0, from_right_ = 0.0;  // distances of the mean from left_ and right_
  double sign_ = 1.0;                     // sign of the curvature of C
  bool fixed_ = false;
  aligned_vector<double> x_, c_, base_, weights_, values_;
};

}  // namespace apsis
