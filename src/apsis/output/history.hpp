#pragma once

#include <apsis/output/table.hpp>

#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace apsis {

/// A bounded record of the steps of a run, one row per step. It keeps up to `most_rows` rows; whenever
/// there are more, the stride doubles. The kept rows are those of steps 0, stride, 2 stride, …, and of the
/// last step. For every column, the first rows with its smallest and largest value are kept too. The
/// extremes of the history are therefore those of all steps. The rows depend only on the steps, not on
/// interruptions and restarts.
class history {
 public:
  /// Makes an empty history. The first column is the step number; `most_rows` must exceed two rows
  /// per column plus two.
  history(std::vector<std::string> columns, std::size_t most_rows);
  /// Continues with the rows and the stride of a checkpoint.
  history(numeric_table rows, long stride, std::size_t most_rows);

  /// Adds the row of the next step, whose first entry is the step number.
  void add(std::vector<double> row);

  /// Returns the rows kept, in order of the steps.
  const numeric_table& rows() const { return rows_; }
  /// Returns the number of steps between regular rows; 1 while every row is kept.
  long stride() const { return stride_; }

 private:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  /// Row numbers of the smallest and the largest value of a column; `none` while all are NaN.
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
