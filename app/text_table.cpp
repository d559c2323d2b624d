#include "text_table.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace apsis::app {

text_table::text_table(std::vector<bool> left) : left_(std::move(left)), widths_(left_.size(), 0) {}

void text_table::add(std::vector<std::string> cells) {
  for (std::size_t k = 0; k < cells.size(); ++k) widths_[k] = std::max(widths_[k], cells[k].size());
  rows_.push_back(std::move(cells));
}

void text_table::add_line(const std::string& text) {
  rows_.push_back({text});
}

std::string text_table::text() const {
  std::string out;
  for (const auto& cells : rows_) {
    std::string line = cells.size() == 1 ? cells.front() : "";
    for (std::size_t k = 0; k < cells.size() && cells.size() > 1; ++k)
      line += fmt::format("{}{}", k > 0 ? "  " : "",
                          left_[k] ? fmt::format("{:<{}}", cells[k], widths_[k])
                                   : fmt::format("{:>{}}", cells[k], widths_[k]));
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  return out;
}

}  // namespace apsis::app
