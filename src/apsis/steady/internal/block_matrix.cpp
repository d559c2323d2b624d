#include <apsis/steady/internal/block_matrix.hpp>

namespace apsis {

double* block_matrix::block(int row, int column) {
  for (int k = newest_[at(row)]; k >= 0; k = earlier_[at(k)])
    if (columns_[at(k)] == column) return values_.data() + at(k) * square();
  const int added = static_cast<int>(columns_.size());
  columns_.push_back(column);
  earlier_.push_back(newest_[at(row)]);
  newest_[at(row)] = added;
  values_.resize(values_.size() + square(), 0.0);
  return values_.data() + at(added) * square();
}

void block_matrix::reserve(std::size_t blocks) {
  columns_.reserve(blocks);
  earlier_.reserve(blocks);
  values_.reserve(blocks * square());
}

}  // namespace apsis
