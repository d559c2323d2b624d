#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace apsis {

/// Numbers in named columns: rows[k][column].
struct numeric_table {
  std::vector<std::string> columns;       ///< one name per entry of a row
  std::vector<std::vector<double>> rows;  ///< [row][column]
};

/// Returns comma-separated text with a header line and 17 significant digits, so that every double is read
/// back unchanged. Columns named in `integers` are written without decimal point.
std::string to_csv(const numeric_table& t, const std::vector<std::string_view>& integers = {});

}  // namespace apsis
