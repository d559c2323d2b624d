#pragma once

#include <apsis/exec/aligned.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace apsis {

/// The velocities of one direction, in increasing order, with the weights of a quadrature ∫f dv ≈ Σ w_j f_j.
/// Dimensionless.
class velocity_line {
 public:
  velocity_line() = default;
  /// Makes a uniform line: midpoints of equal intervals of [−max, max]. Throws input_error unless points ≥ 4
  /// and 0 < max < ∞.
  velocity_line(int points, double max);
  /// Takes points and weights. Throws input_error unless there are at least 4 points and as many weights,
  /// points are finite and increase, and weights are finite and positive.
  velocity_line(std::vector<double> points, std::vector<double> weights);

  int points() const { return static_cast<int>(v_.size()); }  ///< n
  /// Whether the points are midpoints of equal intervals.
  bool uniform() const { return uniform_; }
  /// Returns the width of the intervals, or the smallest distance between neighbours.
  double spacing() const { return spacing_; }
  /// Returns the largest |v|; for equal intervals it lies half an interval beyond the last point.
  double max() const { return max_; }
  const aligned_vector<double>& v() const { return v_; }                      ///< points
  const aligned_vector<double>& half_square() const { return half_square_; }  ///< ½v²
  const aligned_vector<double>& weights() const { return weights_; }          ///< w
  /// Returns the points in the unit of the last set_unit(), by default spacing(). In the default unit, places
  /// of a uniform line are multiples of ½ without rounding.
  const aligned_vector<double>& places() const { return places_; }
  /// Sets the unit of places().
  void set_unit(double unit);
  /// Returns the largest distance between neighbours in the range `from` … `to`, and at least
  /// spacing() (widest_gap.hpp).
  double widest_gap(double from, double to) const;
  bool operator==(const velocity_line&) const = default;  ///< equal points, weights and places

 private:
  void complete();

  bool uniform_ = true;
  double spacing_ = 1.0, max_ = 0.0;
  aligned_vector<double> v_, half_square_, weights_, places_;
};

}  // namespace apsis
