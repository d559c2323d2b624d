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

/// All combinations of the velocities of d = 1, 2, 3 lines, the first direction slowest, with the products of
/// their weights; or those of one line along an axis with the points of rings about it (polar_layout.hpp).
/// The points of one direction, the *last line*, are contiguous in a row: that of the last component, or of
/// the component along the axis.
class velocity_grid {
 public:
  /// Largest number of velocities, such that kernels can count them in int.
  static constexpr int most_velocities = 1 << 30;

  /// Midpoints of equal intervals, the same in all directions. Throws input_error unless 1 ≤ d ≤ 3, points ≥
  /// 4, points^d ≤ most_velocities and max > 0.
  velocity_grid(int dimensions, int points, double max);
  /// Throws input_error unless there are 1 to 3 lines and at most most_velocities combinations.
  explicit velocity_grid(std::vector<velocity_line> lines);
  /// The velocities of a line along an axis, in component `along` = 0 or 2 of three, and of rings about it.
  /// The angle of a ring counts from the first of the other two components. Throws input_error if they are
  /// more than most_velocities.
  velocity_grid(const velocity_line& axial, const polar_rings& rings, int along);

  /// Throws input_error if lines of these lengths have more than most_velocities combinations.
  static void check_size(std::span<const int> points);

  int dimensions() const { return dimensions_; }  ///< d
  int size() const { return size_; }              ///< number of velocities
  /// Whether two components are those of rings about an axis.
  bool is_polar() const { return !polar_.empty(); }
  /// Returns the rings; empty of a product of lines.
  const polar_layout& polar() const { return polar_; }
  /// Returns the velocities of a direction of a product of lines.
  const velocity_line& line(int k) const { return lines_[static_cast<std::size_t>(k)]; }
  /// Returns those along which velocities are contiguous.
  const velocity_line& last_line() const { return lines_.back(); }
  /// Returns the component of the velocity that the last line has: d − 1, or that along the axis.
  int last_component() const { return last_component_; }
  /// Returns component number k < d − 1 of those that are constant on the last lines.
  int component_across(int k) const { return last_component_ == 0 && dimensions_ > 1 ? k + 1 : k; }
  /// Returns the number of last lines, size()/last_line().points().
  int lines() const { return size_ / last_line().points(); }
  /// Returns component_across(k) of the velocities of every last line.
  const double* component_of_lines(int k) const { return of_lines_[static_cast<std::size_t>(k)].data(); }
  /// Whether all lines are uniform. The weights are then equal.
  bool uniform() const { return uniform_; }
  double weight() const { return weight_; }  ///< Δv_1 ⋯ Δv_d, or 1 if not uniform
  double max() const;                        ///< the largest of all directions
  /// Returns the largest speed along a direction, of uniform lines half an interval beyond the last point.
  double max(int k) const;
  double unit() const { return unit_; }  ///< smallest spacing of all lines, the unit of their places()
  /// Returns a_k for every last line, one k after the other: the weight w of the line, w v_k of the other
  /// d − 1 components (component_across()), and w ½Σ v_k² where d > 1. The weights of a line sum with those
  /// along it, and with weight(); they are 1 if uniform.
  const aligned_vector<double>& functions_of_lines() const { return functions_of_lines_; }
  /// Returns the weights along the last line that sum with functions_of_lines(); nullptr: 1.
  const double* weights_of_last() const { return uniform_ ? nullptr : last_line().weights().data(); }
  /// Returns component k of the velocity of every grid point.
  std::span<const double> component(int k) const { return set_.speeds(k); }
  /// Returns the velocities with their weights.
  const velocity_set& set() const { return set_; }
  /// Returns ½|v|² of every grid point.
  const aligned_vector<double>& half_square() const { return half_square_; }

 private:
  std::vector<velocity_line> lines_;  ///< one for each direction, or that along the axis
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
