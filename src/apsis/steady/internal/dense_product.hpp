#pragma once

#include <cstddef>

namespace apsis {

/// Products of dense matrices, for the instruction set of this processor.
namespace dense_product {

/// A block of a matrix that is stored by columns.
struct block {
  double* first;          ///< its first entry
  int rows, columns;      ///< its size
  std::ptrdiff_t stride;  ///< distance between columns

  /// Returns the block at a row and a column of this one.
  block at(int row, int column, int some_rows, int some_columns) const {
    return {first + row + column * stride, some_rows, some_columns, stride};
  }
  double& operator()(int row, int column) const { return first[row + column * stride]; }  ///< an entry
};

/// c ← c − a b. `a` and `b` must not overlap `c`.
void subtract(const block& a, const block& b, const block& c);

}  // namespace dense_product
}  // namespace apsis
