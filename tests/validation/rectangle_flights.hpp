#pragma once

#include <array>
#include <functional>

#include <Eigen/Core>

namespace validation_test {

/// A function of the velocity c = v/v₀ by its parts along 1 and √2 (c_z² − 1/2). These are orthonormal with
/// the weight exp(−c_z²)/√π. A common factor √2 c_z may be omitted from all functions.
using velocity_function = std::function<std::array<double, 2>(double c_x, double c_y)>;

enum class side { left, right, bottom, top };

/// Free flights between collisions at the rate δ in a rectangle [0, width] × [0, height]. The fields do not
/// depend on z. The Galerkin matrices use products of n orthonormal Legendre polynomials inside, and n on
/// each side. They use neither mesh, velocities nor steps of the library. Molecules that started at r' with
/// the velocities g(c) source(r') per unit of δ t contribute to the moment ⟨f φ⟩ at r
///     1/(π s) ∫₀^∞ exp(−t² − δ s/t) ⟨f g⟩(c) dt,   s = |r − r'|, c = t (r − r')/s.
/// Flights that start or end at a side have another factor t cos θ. r and r' enter through their difference
/// d. The integrals over both are thus ∫∫ ds dθ of the kernel times integrals over polynomials alone. In
/// polar coordinates the kernel is smooth except for s log s at s = 0, where points are graded.
class rectangle_flights {
 public:
  /// `n` ≥ 2 is the number of polynomials in each direction.
  rectangle_flights(double delta, int n, double width = 1.0, double height = 1.0);

  int polynomials() const { return n_; }
  /// Returns the matrix from inside to inside, [n²][n²]. The coefficient of φ_i(x) φ_j(y) is at i n + j.
  Eigen::MatrixXd inside(const velocity_function& received, const velocity_function& started) const;
  /// Returns the matrix from a side, [n²][n]. `started` is φ of the molecules that leave it.
  Eigen::MatrixXd from_side(side from, const velocity_function& received,
                            const velocity_function& started) const;
  /// Returns the matrix to a side, [n][n²], for the flux of `received` through it.
  Eigen::MatrixXd to_side(side to, const velocity_function& received, const velocity_function& started) const;
  /// Returns the matrix from side to side, [n][n].
  Eigen::MatrixXd between(side to, side from, const velocity_function& received,
                          const velocity_function& started) const;

 private:
  Eigen::MatrixXd to_opposite(side from, const velocity_function& received,
                              const velocity_function& started) const;
  double length(int axis) const { return axis == 0 ? width_ : height_; }
  /// Sets the points of ∫∫ ds dθ over all differences d.
  void set_differences();
  /// Returns ∫ t^ends exp(−t² − δ s/t) ⟨f g⟩ dt / π for each difference.
  Eigen::VectorXd kernel(const Eigen::MatrixXd& kept, const Eigen::MatrixXd& direction, int ends,
                         const velocity_function& f, const velocity_function& g) const;
  /// Returns exp(−t² − δ s/t) Δt for distances s.
  Eigen::MatrixXd kept(const Eigen::VectorXd& distance) const;
  /// Returns the polynomials of an axis at points, [points][n].
  Eigen::MatrixXd polynomials(int axis, const Eigen::VectorXd& at) const;
  /// Returns ∫ φ_i(x + d) φ_j(x) dx for differences d along an axis, [differences][i n + j].
  Eigen::MatrixXd correlations(int axis, const Eigen::VectorXd& d) const;

  double delta_, width_, height_;
  int n_;
  Eigen::VectorXd speed_, speed_weight_, distance_, weight_;
  Eigen::MatrixXd direction_, kept_;             ///< unit vector and attenuation by speed of each difference
  std::array<Eigen::MatrixXd, 2> correlations_;  ///< along x and y
};

}  // namespace validation_test
