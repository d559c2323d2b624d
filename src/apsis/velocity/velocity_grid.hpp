#pragma once

#include <apsis/exec/aligned.hpp>
#include <apsis/velocity/velocity_line.hpp>
#include <apsis/velocity/velocity_set.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace apsis {

/// All combinations of the velocities of d = 1, 2, 3 lines, the first direction slowest, with the products of
/// their weights.
class velocity_grid {
 public:
  /// Largest number of velocities, such that kernels can count them in int.
  static constexpr int most_velocities = 1 << 30;

  /// Midpoints of equal intervals, the same in all directions. Throws input_error unless 1 ≤ d ≤ 3, points ≥
  /// 4, points^d ≤ most_velocities and max > 0.
  velocity_grid(int dimensions, int points, double max);
  /// Throws input_error unless there are 1 to 3 lines and at most most_velocities combinations.
  explicit velocity_grid(std::vector<velocity_line> lines);

  /// Throws input_error if lines of these lengths have more than most_velocities combinations.
  static void check_size(std::span<const int> points);

  int dimensions() const { return static_cast<int>(lines_.size()); }  ///< d
  int size() const { return size_; }                                  ///< number of velocities
  /// Returns the velocities of a direction.
  const velocity_line& line(int k) const { return lines_[static_cast<std::size_t>(k)]; }
  /// Returns those of the last direction, along which velocities are contiguous.
  const velocity_line& last_line() const { return lines_.back(); }
  /// Returns the number of lines in the last direction, size()/last_line().points().
  int lines() const { return size_ / last_line().points(); }
  /// Returns component k < d − 1 of the velocities of every line in the last direction.
  const double* component_of_lines(int k) const { return of_lines_[static_cast<std::size_t>(k)].data(); }
  /// Whether all lines are uniform. The weights are then equal.
  bool uniform() const { return uniform_; }
  double weight() const { return weight_; }  ///< Δv_1 ⋯ Δv_d, or 1 if not uniform
  double max() const;                        ///< the largest of all lines
  double unit() const { return unit_; }      ///< smallest spacing of all lines, the unit of their places()
  /// Returns a_k for every line in the last direction, one k after the other: the weight w of the line, w v_k
  /// of the other d − 1 directions, and w ½Σ v_k² where d > 1. The weights of a line sum with those of the
  /// last direction, and with weight(); they are 1 if uniform.
  const aligned_vector<double>& functions_of_lines() const { return functions_of_lines_; }
  /// Returns the weights along the last direction that sum with functions_of_lines(); nullptr: 1.
  const double* weights_of_last() const { return uniform_ ? nullptr : last_line().weights().data(); }
  /// Returns component k of the velocity of every grid point.
  std::span<const double> component(int k) const { return set_.speeds(k); }
  /// Returns the velocities with their weights.
  const velocity_set& set() const { return set_; }
  /// Returns ½|v|² of every grid point.
  const aligned_vector<double>& half_square() const { return half_square_; }

 private:
  std::vector<velocity_line> lines_;
  int size_ = 1;
  bool uniform_ = true;
  double weight_ = 1.0, unit_ = 0.0;
  aligned_vector<double> half_square_, functions_of_lines_;
  std::vector<std::vector<double>> of_lines_;
  void make_functions_of_lines();
  velocity_set set_;
};

}  // namespace apsis
