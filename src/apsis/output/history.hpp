#pragma once

#include <apsis/output/table.hpp>

#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace apsis {

/// The rows of a run, one per step, of which a bounded number is kept. While there are at most `most_rows`,
/// all are. After that the stride doubles whenever they become more: the rows kept are those of the steps 0,
/// stride, 2 stride, …, the last one, and for every column the first row of its smallest and of its largest
/// value, so that the extremes of the history are those of all steps. The rows depend on the steps only, not
/// on where a run was interrupted and continued.
class history {
 public:
  /// No rows. The first column is the number of the step; `most_rows` must exceed two rows per column and
  /// two.
  history(std::vector<std::string> columns, std::size_t most_rows);
  /// Continues with the rows and the stride of a checkpoint.
  history(numeric_table rows, long stride, std::size_t most_rows);

  /// Adds the row of the next step; its first number is the number of the step.
  void add(std::vector<double> row);

  /// The rows that are kept, in the order of the steps.
  const numeric_table& rows() const { return rows_; }
  /// Steps from one regular row to the next; 1 while every row is kept.
  long stride() const { return stride_; }

 private:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  /// Rows of the smallest and the largest value of a column; none while all are NaN.
  struct extremes {
    std::size_t smallest = none, largest = none;
  };

  double value(std::size_t row, std::size_t column) const { return rows_.rows[row][column]; }
  void note_extremes(std::size_t row);
  bool is_regular(std::size_t row) const;
  bool is_extreme(std::size_t row) const;
  void thin();

  numeric_table rows_;
  long stride_ = 1;
  std::size_t most_rows_;
  std::vector<extremes> extremes_;
};

}  // namespace apsis
