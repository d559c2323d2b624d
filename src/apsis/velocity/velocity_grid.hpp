#pragma once

#include <apsis/exec/aligned.hpp>
#include <apsis/velocity/polar_layout.hpp>
#include <apsis/velocity/polar_rings.hpp>
#include <apsis/velocity/velocity_line.hpp>
#include <apsis/velocity/velocity_set.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace apsis {

/// A grid of discrete velocities. A product grid has all combinations of the velocities of d = 1, 2, 3 lines,
/// with the first direction slowest, and the products of their weights. A polar grid combines one line along
/// an axis with the points of rings about it (polar_layout.hpp).
///
/// The points of one direction, the *last line*, are contiguous in a row. This is the direction of the last
/// component, or of the component along the axis. Dimensionless.
class velocity_grid {
 public:
  /// Largest number of velocities, so that kernels can count them in int.
  static constexpr int most_velocities = 1 << 30;

  /// Makes a grid of midpoints of equal intervals of [−max, max], the same in all directions. Throws
  /// input_error unless 1 ≤ d ≤ 3, points ≥ 4, points^d ≤ most_velocities and 0 < max < ∞.
  velocity_grid(int dimensions, int points, double max);
  /// Makes the product grid of the lines. Throws input_error unless there are 1 to 3 lines and at most
  /// most_velocities combinations.
  explicit velocity_grid(std::vector<velocity_line> lines);
  /// Makes the polar grid of a line along an axis and of rings about it. The axis is component `along` = 0 or
  /// 2 of three. Angles of rings count from the first of the other two components. Throws input_error for
  /// more than most_velocities velocities.
  velocity_grid(const velocity_line& axial, const polar_rings& rings, int along);

  /// Throws input_error if lines of these lengths have more than most_velocities combinations.
  static void check_size(std::span<const int> points);

  int dimensions() const { return dimensions_; }  ///< d
  int size() const { return size_; }              ///< number of velocities
  /// Whether this is a polar grid, with rings about an axis.
  bool is_polar() const { return !polar_.empty(); }
  /// Returns the rings; empty for a product of lines.
  const polar_layout& polar() const { return polar_; }
  /// Returns the velocities along direction k of a product of lines.
  const velocity_line& line(int k) const { return lines_[static_cast<std::size_t>(k)]; }
  /// Returns the last line, along which velocities are contiguous.
  const velocity_line& last_line() const { return lines_.back(); }
  /// Returns the component along the last line: d − 1, or the component along the axis.
  int last_component() const { return last_component_; }
  /// Returns number k < d − 1 of the components that are constant on every last line.
  int component_across(int k) const { return last_component_ == 0 && dimensions_ > 1 ? k + 1 : k; }
  /// Returns the number of last lines, size()/last_line().points().
  int lines() const { return size_ / last_line().points(); }
  /// Returns the velocities along component_across(k), one for every last line.
  const double* component_of_lines(int k) const { return of_lines_[static_cast<std::size_t>(k)].data(); }
  /// Whether all lines are uniform. The weights are then equal.
  bool uniform() const { return uniform_; }
  double weight() const { return weight_; }  ///< Δv_1 ⋯ Δv_d, or 1 if not uniform
  double max() const;                        ///< largest speed over all directions
  /// Returns the largest speed along direction k. For uniform lines it lies half an interval beyond the
  /// last point.
  double max(int k) const;
  double unit() const { return unit_; }  ///< smallest spacing of all lines, the unit of their places()
  /// Returns functions a_k with a value for every last line, one k after the other. These are the weight w of
  /// the line, w v_k for the other d − 1 components (component_across()), and w ½Σ v_k² if d > 1. The weight
  /// of a velocity is w times its weight along the line times weight(). w = 1 on a uniform grid.
  const aligned_vector<double>& functions_of_lines() const { return functions_of_lines_; }
  /// Returns the weights along the last line that belong to functions_of_lines(); nullptr if all are 1.
  const double* weights_of_last() const { return uniform_ ? nullptr : last_line().weights().data(); }
  /// Returns component k of every velocity, size() numbers.
  std::span<const double> component(int k) const { return set_.speeds(k); }
  /// Returns the velocities with their weights.
  const velocity_set& set() const { return set_; }
  /// Returns ½|v|² of every velocity, size() numbers.
  const aligned_vector<double>& half_square() const { return half_square_; }

 private:
  std::vector<velocity_line> lines_;  ///< one for each direction, or the line along the axis
  polar_layout polar_;
  int dimensions_ = 0, last_component_ = 0;
  int size_ = 1;
  bool uniform_ = true;
  double weight_ = 1.0, unit_ = 0.0;
  aligned_vector<double> half_square_, functions_of_lines_;
  std::vector<std::vector<double>> of_lines_;
  std::vector<double> weights_of_lines() const;
  void make_functions_of_lines(const std::vector<double>& weights_of_lines);
  velocity_set set_;
};

}  // namespace apsis
