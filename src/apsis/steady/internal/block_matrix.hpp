#pragma once

#include <apsis/core/index.hpp>

#include <cstddef>
#include <vector>

namespace apsis {

/// A sparse matrix of square blocks. The first access to a block creates it. A row has only a few blocks.
class block_matrix {
 public:
  block_matrix() = default;
  /// `rows` is the number of rows of blocks, and `size` that of rows of a block.
  block_matrix(int rows, int size) : size_(size), newest_(at(rows), -1) {}

  int rows() const { return static_cast<int>(newest_.size()); }  ///< number of rows of blocks
  int size() const { return size_; }                             ///< rows of a block
  /// Returns the number of blocks.
  std::size_t blocks() const { return columns_.size(); }

  /// Returns a block, [row in it][column in it], initially 0. The pointer is valid until the next call.
  double* block(int row, int column);
  /// Returns the entry at a row and a column of numbers.
  double& entry(int row, int column) {
    return block(row / size_, column / size_)[row % size_ * size_ + column % size_];
  }
  /// Calls visit(column, block) for each block of a row of blocks.
  template <class Visit>
  void visit_row(int row, const Visit& visit) const {
    for (int k = newest_[at(row)]; k >= 0; k = earlier_[at(k)]) visit(columns_[at(k)], values(k));
  }
  /// Reserves memory for this number of blocks.
  void reserve(std::size_t blocks);

 private:
  std::size_t square() const { return at(size_ * size_); }
  const double* values(int k) const { return values_.data() + at(k) * square(); }

  int size_ = 1;
  std::vector<int> newest_ = {};             ///< newest block of a row, or -1
  std::vector<int> columns_ = {}, earlier_;  ///< column of a block, and the previous block of its row
  std::vector<double> values_ = {};
};

}  // namespace apsis
