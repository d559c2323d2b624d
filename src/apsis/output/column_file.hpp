#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace apsis {

/// Named columns of numbers from a text.
struct column_file {
  std::map<std::string, std::vector<double>> columns;  ///< equally long; NaN where there is no finite number
  std::map<std::string, std::string> problems;         ///< of a column: why its first NaN is one
  std::vector<int> lines;                              ///< line of each row, from 1
};

/// Reads comma-separated numbers below a line of names. Blank lines and lines that begin with # are skipped.
/// A column may have entries that are not finite numbers, since nobody may ask for it. Throws input_error
/// with file and line: no names, the same name twice, or another number of entries; io_error if the file
/// cannot be read.
column_file read_columns(const std::string& path);

}  // namespace apsis
