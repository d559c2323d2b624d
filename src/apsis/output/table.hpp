#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace apsis {

/// Numbers in named columns: rows[k][column]. Dimensionless throughout.
struct numeric_table {
  std::vector<std::string> columns;       ///< names, one for each number of a row
  std::vector<std::vector<double>> rows;  ///< [row][column]
};

/// Comma-separated text with one header line; 17 significant digits, so that every double reads back
/// unchanged. Columns named in `integers` are written without digits after the point.
std::string to_csv(const numeric_table& t, const std::vector<std::string_view>& integers = {});

}  // namespace apsis
