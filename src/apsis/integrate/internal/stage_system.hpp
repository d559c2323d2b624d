#pragma once

#include <apsis/integrate/guarded_newton.hpp>

#include <cmath>
#include <span>

#include <Eigen/Dense>

namespace apsis {

/// Linear systems of unsquared_newton(): with J = G'(v) and H = G''(v)[k, ·] of a stage equation,
///   S = ( M − bH   −aM − bJ )
///       (  −J          M    )
/// for the unknowns (v, k), n of each. M is the mass matrix, or 1.
template <class Real>
class stage_system {
 public:
  using column = Eigen::Matrix<Real, Eigen::Dynamic, 1>;  ///< 2n numbers, v before k

  virtual ~stage_system() = default;
  /// Computes and factorizes S at x = (v, k). Returns false if a derivative is not finite.
  virtual bool linearize(stage_equation<Real>& equation, const column& x) = 0;
  /// Returns S⁻¹ r.
  virtual column solve(const column& r) const = 0;
  /// Returns |J| x for n numbers x.
  virtual column sizes_times(const column& x) const = 0;
  /// Returns the size of S⁻¹ e for errors e of the given sizes and any signs.
  virtual column spread(const column& sizes) const = 0;
  /// Returns for each k_i the smallest size_j/|s_ji| over the equations j of v; +infinity if k_i enters no
  /// equation. A change of k_i by this value changes no equation by more than its size.
  virtual column changes_of_rates(const column& sizes) const = 0;
  /// Returns a power of 2 near x > 0: scaling with it causes no rounding errors.
  static Real power_of_2(Real x) { return std::exp2(std::round(std::log2(x))); }
};

}  // namespace apsis
