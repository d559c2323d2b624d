#pragma once

#include <apsis/exec/aligned.hpp>

#include <cstddef>
#include <vector>

namespace apsis {

/// The state of a semidiscrete problem: one row of `components` numbers per cell, rows one after the other in
/// the order of the grid. Rows of eight or more are padded with zeros to whole cache lines, so that every row
/// is aligned and a vector loop has no remainder.
class field {
 public:
  field() = default;
  /// All numbers are 0. Throws std::bad_alloc, also where there are more numbers than addresses.
  field(int cells, int components)
      : cells_(cells), components_(components), stride_(padded(components)), data_(numbers(cells, stride_)) {
    fill_rows(nullptr);
  }
  /// Padding included, row by row on the thread that works on it.
  field(const field& other)
      : cells_(other.cells_),
        components_(other.components_),
        stride_(other.stride_),
        data_(other.data_.size()) {
    fill_rows(other.data_.data());
  }
  /// Without allocation where the sizes are equal.
  field& operator=(const field& other) {
    if (data_.size() != other.data_.size()) return *this = field(other);
    cells_ = other.cells_;
    components_ = other.components_;
    stride_ = other.stride_;
    fill_rows(other.data_.data());
    return *this;
  }
  field(field&&) noexcept = default;             ///< the other has sizes, but no rows then
  field& operator=(field&&) noexcept = default;  ///< likewise
  ~field() = default;

  int cells() const { return cells_; }            ///< number of rows
  int components() const { return components_; }  ///< numbers of a row, padding not counted
  /// Numbers from one row to the next, padding included.
  int stride() const { return stride_; }

  /// The stride of rows of so many components.
  static int padded(int components) { return components < 8 ? components : (components + 7) / 8 * 8; }

  /// The components of cell 0 … cells() − 1, not checked.
  double* row(int cell) {
    return data_.data() + static_cast<std::size_t>(cell) * static_cast<std::size_t>(stride_);
  }
  /// The same of a constant field.
  const double* row(int cell) const {
    return data_.data() + static_cast<std::size_t>(cell) * static_cast<std::size_t>(stride_);
  }

 private:
  static std::size_t numbers(int cells, int stride);

  /// From `values`, or zeros where that is null. Each thread writes the rows that it works on later, so that
  /// their memory lies near to it (a page belongs to whom touches it first).
  void fill_rows(const double* values);

  int cells_ = 0, components_ = 0, stride_ = 0;
  std::vector<double, untouched_allocator<double>> data_;
};

}  // namespace apsis
