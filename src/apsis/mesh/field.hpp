#pragma once

#include <apsis/exec/memory_space.hpp>

#include <cstddef>

namespace apsis {

/// Storage for the unknowns of a semi-discrete problem: one row of `components` numbers per cell, in the
/// order of the grid. Rows of eight or more numbers are padded with zeros to whole cache lines. Every row is
/// then aligned, and vector loops have no remainder.
class field {
 public:
  field() = default;
  /// Makes a field of zeros in the given memory. Throws std::bad_alloc if memory does not suffice, or if the
  /// size exceeds the address space.
  field(int cells, int components, const memory_space& memory = host_memory())
      : cells_(cells),
        components_(components),
        stride_(padded(components)),
        data_(numbers(cells, stride_), memory) {
    clear();
  }
  /// Copies rows, including padding, into new rows of the same memory space. The threads that will work on
  /// the rows copy them (first touch).
  field(const field& other)
      : cells_(other.cells_),
        components_(other.components_),
        stride_(other.stride_),
        data_(other.data_.size(), other.memory()) {
    copy_numbers(other);
  }
  /// Copies rows. Allocates nothing if the sizes and the memory space are equal.
  field& operator=(const field& other) {
    if (data_.size() != other.data_.size() || &memory() != &other.memory()) return *this = field(other);
    cells_ = other.cells_;
    components_ = other.components_;
    stride_ = other.stride_;
    copy_numbers(other);
    return *this;
  }
  field(field&&) noexcept = default;             ///< leaves the source with sizes but without rows
  field& operator=(field&&) noexcept = default;  ///< leaves the source with sizes but without rows
  ~field() = default;

  int cells() const { return cells_; }            ///< number of rows
  int components() const { return components_; }  ///< numbers of a row without padding
  /// Returns the distance between rows, including padding.
  int stride() const { return stride_; }
  std::size_t size() const { return data_.size(); }             ///< numbers of all rows with their padding
  const memory_space& memory() const { return data_.space(); }  ///< memory space of the rows

  /// Returns the stride of rows with the given number of components.
  static int padded(int components) { return components < 8 ? components : (components + 7) / 8 * 8; }

  /// Copies the rows of a field of equal sizes, which may be in another memory space. Throws
  /// std::invalid_argument if the sizes differ.
  void copy_rows(const field& from);

  /// Returns the row of a cell, 0 … cells() − 1 (not checked). The pointer refers to memory().
  double* row(int cell) {
    return data_.data() + static_cast<std::size_t>(cell) * static_cast<std::size_t>(stride_);
  }
  /// Returns the row of a cell of a constant field.
  const double* row(int cell) const {
    return data_.data() + static_cast<std::size_t>(cell) * static_cast<std::size_t>(stride_);
  }

 private:
  static std::size_t numbers(int cells, int stride);

  // Each thread writes the rows that it works on later, so that their pages are local to it (first touch).
  void clear();
  void copy_numbers(const field& other);

  int cells_ = 0, components_ = 0, stride_ = 0;
  stored_numbers data_;
};

}  // namespace apsis
