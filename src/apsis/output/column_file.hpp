#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace apsis {

/// Named columns of numbers from a text.
struct column_file {
  std::map<std::string, std::vector<double>> columns;  ///< equally long; NaN where there is no finite number
  std::map<std::string, std::string> problems;         ///< message about the first NaN of a column
  std::vector<int> lines;                              ///< line of each row, from 1
};

/// Reads comma-separated numbers below a line of names. Skips blank lines and lines that begin with #.
/// Accepts entries that are not finite numbers, because the column may not be needed. Throws input_error with
/// file and line if a name occurs twice, or if a row has another number of entries. Also throws it if there
/// are no rows, and io_error if the file cannot be read.
column_file read_columns(const std::string& path);

}  // namespace apsis
