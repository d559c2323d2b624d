#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace apsis {

/// Places where the derivative G' of n unknowns may differ from 0, and groups of its columns. One product G'x
/// reveals a group, because no two columns of a group have an entry in the same row (Curtis, Powell & Reid,
/// J. Inst. Maths Applics 13 (1974) 117). The diagonal always belongs to the pattern. In their order, columns
/// join the first group that fits. A banded pattern then has lower + upper + 1 groups, the fewest possible.
class sparsity_pattern {
 public:
  /// A place (row, column), from 0.
  using place = std::pair<std::size_t, std::size_t>;

  /// The pattern of the given places, which may repeat, and of the diagonal. Throws input_error for n = 0 and
  /// for a place outside.
  sparsity_pattern(std::size_t n, const std::vector<place>& places);

  /// The places with −upper ≤ row − column ≤ lower. Throws input_error for n = 0.
  static sparsity_pattern banded(std::size_t n, std::size_t lower, std::size_t upper);

  /// The pattern with more places. Throws input_error for a place outside.
  sparsity_pattern joined_with(std::vector<place> more) const;

  std::size_t size() const { return begin_.size() - 1; }  ///< n
  std::size_t entries() const { return rows_.size(); }    ///< number of places
  /// Index of the first entry of a column among all entries, which are in the order of columns; begin(n) is
  /// entries().
  std::size_t begin(std::size_t column) const { return begin_[column]; }
  /// Rows of the entries of a column, in increasing order.
  std::span<const std::size_t> rows(std::size_t column) const {
    return std::span(rows_).subspan(begin_[column], begin_[column + 1] - begin_[column]);
  }
  /// Groups of columns; every column is in one of them.
  const std::vector<std::vector<std::size_t>>& groups() const { return groups_; }

 private:
  void group_columns();

  std::vector<std::size_t> begin_, rows_;
  std::vector<std::vector<std::size_t>> groups_;
};

}  // namespace apsis
