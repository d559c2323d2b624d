#pragma once

#include <vector>

#include <Eigen/Core>

namespace validation_test {

/// The steady linearized BGK equation between diffuse plates at x = 0 and 1,
///     c_x φ_x = δ (ρ + 2 c·u + (c² − 3/2) τ − φ),   c = v/v₀, δ = pL/(μ v₀),
/// for data antisymmetric or symmetric about the middle. The solution uses neither mesh nor velocities of the
/// library. It is exact along characteristics for sources that are linear between nodes. The moments of φ are
/// then a matrix times those of the source plus the emission of the plates. They solve a dense linear system.
/// Nodes are graded towards the plates. Speeds are c = 6 s³ with s at midpoints. The error is of second order
/// in 1/cells.
class linear_plates {
 public:
  linear_plates(double delta, int cells, int speeds = 100);

  /// Returns the shear stress between plates that move along themselves, over its free-molecular value.
  double shear_stress() const;
  /// Returns the heat flux between plates of different temperature, over its free-molecular value.
  double heat_flux() const;
  /// Returns the velocity at the nodes. The plate at x = 0 moves with 1, the plate at x = 1 with −1.
  Eigen::VectorXd velocity() const;
  const Eigen::VectorXd& nodes() const { return x_; }
  /// Returns the flow rate 2 ∫ u dx along the plates for a pressure gradient of 1 along them.
  double flow_rate() const;

 private:
  /// Returns the moment of weights c^k over c > 0.
  double half_range(int k) const;

  double delta_;
  Eigen::VectorXd x_, speed_, weight_;
  /// Moments Σ w c^k φ over c_x > 0. of_source_[k] multiplies the source, of_plate_[k] multiplies φ
  /// at the plate.
  std::vector<Eigen::MatrixXd> of_source_;
  std::vector<Eigen::VectorXd> of_plate_;
};

/// Returns the limit of values f(cells) from f(n) and f(2n), for an error of second order.
template <class Function>
double extrapolated(int n, const Function& f) {
  return (4.0 * f(2 * n) - f(n)) / 3.0;
}

}  // namespace validation_test
