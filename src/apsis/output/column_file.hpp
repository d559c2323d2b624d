#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace apsis {

/// Named columns of numbers from a text.
struct column_file {
  std::map<std::string, std::vector<double>> columns;  ///< equally long
  std::vector<int> lines;                              ///< line of each row, from 1
};

/// Reads comma-separated numbers below a line of names. Blank lines and lines that begin with # are skipped.
/// Throws input_error with file and line: no names, the same name twice, another number of entries, or an
/// entry that is not a finite number; io_error if the file cannot be read.
column_file read_columns(const std::string& path);

}  // namespace apsis
