#pragma once

#include <apsis/velocity/velocity_set.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace apsis {

/// The axes of velocities that form a tensor product: all combinations of numbers in each of d directions.
/// The last direction varies fastest in a row. Dimensionless.
class tensor_axes {
 public:
  /// A position on an axis: an interval and the relative position inside.
  struct place {
    std::size_t below;  ///< index of the lower end of the interval
    double share;       ///< 0 at the lower end, 1 at the upper one
  };

  /// Throws input_error unless the velocities form a tensor product with at least two numbers
  /// in each direction.
  explicit tensor_axes(const velocity_set& velocities);

  /// Returns d.
  std::size_t dimensions() const { return points_.size(); }
  /// Returns the numbers of a direction, in increasing order.
  const std::vector<double>& points(std::size_t k) const { return points_[k]; }
  /// Returns the numbers of the last direction.
  const std::vector<double>& last() const { return points_.back(); }
  /// Returns the distance in a row between neighbours along a direction.
  std::size_t stride(std::size_t k) const { return strides_[k]; }
  /// Returns the number of velocities.
  std::size_t size() const { return size_; }
  /// Returns the number of lines in the last direction.
  std::size_t lines() const { return size_ / last().size(); }
  /// Returns the indices of a line in the last direction; the last index is 0.
  std::array<std::size_t, 3> indices_of_line(std::size_t line) const;
  /// Returns true if the numbers of a direction and the weights of the velocities are symmetric.
  bool is_symmetric(std::size_t k) const { return symmetric_[k]; }
  /// Returns the place of a number on an axis. Numbers beyond the ends are moved to the ends.
  place find(std::size_t k, double v) const {
    const double* all = points_[k].data();
    const bins& of = bins_[k];
    const double at = (v - all[0]) * of.per_unit;
    const int bin = static_cast<int>(at > 0.0 ? (at < of.last ? at : of.last) : 0.0);
    auto below = static_cast<std::size_t>(of.first[static_cast<std::size_t>(bin)]);
    while (below > 0 && v < all[below]) --below;
    while (below + 2 < points_[k].size() && v >= all[below + 1]) ++below;
    const double share = (v - all[below]) * of.inverse_gaps[below];
    return {below, share > 0.0 ? (share < 1.0 ? share : 1.0) : 0.0};
  }

 private:
  void add_axis(const velocity_set& velocities, std::size_t k);

  /// Equal bins along an axis, for fast search.
  struct bins {
    double per_unit = 0.0, last = 0.0;  ///< bins per unit of velocity, and index of the last one
    std::vector<int> first = {};        ///< interval at the lower end of each bin
    std::vector<double> inverse_gaps = {};
  };

  std::vector<std::vector<double>> points_;
  std::vector<bins> bins_;
  std::vector<std::size_t> strides_;
  std::vector<bool> symmetric_;
  std::size_t size_ = 1;
};

}  // namespace apsis
