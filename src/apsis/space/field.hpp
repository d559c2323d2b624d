#pragma once

#include <apsis/core/aligned.hpp>

#include <cstddef>
#include <vector>

namespace apsis {

/// The state of a semidiscrete problem: one row of `components` numbers per cell, rows one after the other in
/// the order of the grid. Rows of eight or more are padded with zeros to whole cache lines, so that every row
/// is aligned and a vector loop has no remainder.
class field {
 public:
  field() = default;
  field(int cells, int components)
      : cells_(cells),
        components_(components),
        stride_(padded(components)),
        data_(static_cast<std::size_t>(cells) * static_cast<std::size_t>(stride_), 0.0) {}

  int cells() const { return cells_; }
  int components() const { return components_; }
  /// Numbers from one row to the next, padding included.
  int stride() const { return stride_; }

  double* row(int cell) {
    return data_.data() + static_cast<std::size_t>(cell) * static_cast<std::size_t>(stride_);
  }
  const double* row(int cell) const {
    return data_.data() + static_cast<std::size_t>(cell) * static_cast<std::size_t>(stride_);
  }

 private:
  static int padded(int components) { return components < 8 ? components : (components + 7) / 8 * 8; }

  int cells_ = 0, components_ = 0, stride_ = 0;
  aligned_vector<double> data_;
};

}  // namespace apsis
