#pragma once

#include <string>
#include <vector>

namespace apsis {

/// A small table of the report; cells are texts.
struct report_table {
  std::string title;                           ///< above the table
  std::vector<std::string> columns;            ///< heads of the columns
  std::vector<std::vector<std::string>> rows;  ///< [row][column]
};

}  // namespace apsis
