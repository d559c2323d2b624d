#include <apsis/output/column_file.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/text_file.hpp>
#include <apsis/exec/interruption.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

namespace apsis {
namespace {

constexpr std::size_t longest = 1'000'000'000;  ///< largest size of a file in bytes

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  text = text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
  if (text.size() > 1 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return text;
}

std::vector<std::string_view> entries_of(std::string_view line) {
  std::vector<std::string_view> entries;
  for (std::size_t from = 0; from <= line.size();) {
    const std::size_t to = std::min(line.find(',', from), line.size());
    entries.push_back(trimmed(line.substr(from, to - from)));
    from = to + 1;
  }
  return entries;
}

/// Returns the number of an entry; NaN for one that is not a finite number.
double number_of(std::string_view text) {
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  double value = 0.0;
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool finite = problem == std::errc() && end == digits.data() + digits.size() && std::isfinite(value);
  return finite ? value : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

column_file read_columns(const std::string& path) {
  const std::string text = read_text_file(path, longest, "table of numbers");
  if (text.size() > longest)
    throw input_error({path, 0, 0},
                      fmt::format("the table has more than {} bytes; give an HDF5 file", longest));
  column_file table;
  std::vector<std::string> names;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    interruptible::poll();
    std::string_view rest = line;
    if (number == 1 && rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);  // byte order mark
    rest = trimmed(rest);
    if (rest.empty() || rest.starts_with('#')) continue;
    const auto entries = entries_of(rest);
    const source_place place{path, number, 0};
    if (names.empty()) {
      names.assign(entries.begin(), entries.end());
      for (const auto& name : names)
        if (!table.columns.emplace(name, std::vector<double>()).second)
          throw input_error(
              place,
              fmt::format("column '{}' appears twice (a column is found by its name); rename one of them",
                          name));
      continue;
    }
    if (entries.size() != names.size())
      throw input_error(place, fmt::format("{} entries (the first line names {} columns); give {}",
                                           entries.size(), names.size(), names.size()));
    for (std::size_t k = 0; k < names.size(); ++k) {
      const double value = number_of(entries[k]);
      table.columns[names[k]].push_back(value);
      if (std::isnan(value))
        table.problems.try_emplace(
            names[k], fmt::format("{}'{}' in column '{}' is not a finite number; change it", to_string(place),
                                  entries[k].substr(0, 40), names[k]));
    }
    table.lines.push_back(number);
  }
  if (table.lines.empty())
    throw input_error(
        {path, 0, 0},
        "the table has no rows (a line of names and rows of numbers are needed); give another file");
  return table;
}

}  // namespace apsis
