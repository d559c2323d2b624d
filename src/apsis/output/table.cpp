#include <apsis/output/table.hpp>

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {

std::string to_csv(const numeric_table& t, const std::vector<std::string_view>& integers) {
  fmt::memory_buffer out;
  fmt::format_to(std::back_inserter(out), "{}\n", fmt::join(t.columns, ","));
  std::vector<bool> whole;
  for (const auto& name : t.columns)
    whole.push_back(std::find(integers.begin(), integers.end(), name) != integers.end());
  for (const auto& row : t.rows) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (k > 0) out.push_back(',');
      if (whole[k])
        fmt::format_to(std::back_inserter(out), "{:.0f}", row[k]);
      else
        fmt::format_to(std::back_inserter(out), "{:.17g}", row[k]);
    }
    out.push_back('\n');
  }
  return fmt::to_string(out);
}

}  // namespace apsis
