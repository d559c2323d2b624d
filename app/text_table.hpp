#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace apsis::app {

/// A table of text. Columns are as wide as their longest cell, and two blanks apart.
class text_table {
 public:
  /// `left`: whether each column is aligned to the left; numbers are aligned to the right.
  explicit text_table(std::vector<bool> left);

  /// Adds a row of one cell for each column.
  void add(std::vector<std::string> cells);
  /// Adds a line across all columns.
  void add_line(const std::string& text);

  /// Returns the lines, without blanks at their ends.
  std::string text() const;

 private:
  std::vector<bool> left_;
  std::vector<std::size_t> widths_;
  std::vector<std::vector<std::string>> rows_;  ///< a row of one cell is a line across all columns
};

}  // namespace apsis::app
