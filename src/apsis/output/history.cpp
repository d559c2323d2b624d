#include <apsis/output/history.hpp>

#include <algorithm>
#include <cmath>

namespace apsis {

history::history(std::vector<std::string> columns, std::size_t most_rows)
    : history({std::move(columns), {}}, 1, most_rows) {}

history::history(numeric_table rows, long stride, std::size_t most_rows)
    : rows_(std::move(rows)), stride_(stride), most_rows_(most_rows), extremes_(rows_.columns.size()) {
  for (std::size_t row = 0; row < rows_.rows.size(); ++row) note_extremes(row);
}

void history::add(std::vector<double> row) {
  rows_.rows.push_back(std::move(row));
  const std::size_t last = rows_.rows.size() - 1;
  note_extremes(last);
  // The previous row was kept as the last one and is kept now only if it is regular or extreme.
  if (last >= 2 && !is_regular(last - 1) && !is_extreme(last - 1)) {
    rows_.rows[last - 1] = std::move(rows_.rows[last]);
    rows_.rows.pop_back();
    for (extremes& column : extremes_) {
      if (column.smallest == last) column.smallest = last - 1;
      if (column.largest == last) column.largest = last - 1;
    }
  }
  while (rows_.rows.size() > most_rows_) {
    stride_ *= 2;
    thin();
  }
}

void history::note_extremes(std::size_t row) {
  for (std::size_t column = 0; column < extremes_.size(); ++column) {
    const double x = value(row, column);
    if (std::isnan(x)) continue;
    extremes& now = extremes_[column];
    if (now.smallest == none || x < value(now.smallest, column)) now.smallest = row;
    if (now.largest == none || x > value(now.largest, column)) now.largest = row;
  }
}

bool history::is_regular(std::size_t row) const {
  return row == 0 || static_cast<long>(value(row, 0)) % stride_ == 0;
}

bool history::is_extreme(std::size_t row) const {
  return std::any_of(extremes_.begin(), extremes_.end(), [row](const extremes& column) {
    return column.smallest == row || column.largest == row;
  });
}

void history::thin() {
  std::vector<std::vector<double>> kept;
  for (std::size_t row = 0; row < rows_.rows.size(); ++row)
    if (is_regular(row) || is_extreme(row) || row + 1 == rows_.rows.size())
      kept.push_back(std::move(rows_.rows[row]));
  rows_.rows = std::move(kept);
  extremes_.assign(extremes_.size(), {});
  for (std::size_t row = 0; row < rows_.rows.size(); ++row) note_extremes(row);
}

}  // namespace apsis
