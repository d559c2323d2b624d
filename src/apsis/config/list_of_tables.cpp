#include <apsis/config/list_of_tables.hpp>

#include <charconv>

namespace apsis {

std::optional<std::size_t> table_number(std::string_view word) {
  int number = 0;
  const char* const begin = word.data();
  const char* const end = begin + word.size();
  const auto [stop, problem] = std::from_chars(begin, end, number);
  if (problem != std::errc() || stop != end || number < 1 || number > most_listed_tables) return std::nullopt;
  return static_cast<std::size_t>(number);
}

std::optional<key_of_table> split_key(const std::string& path, std::string_view list) {
  const auto dot = path.find('.', list.size());
  if (dot == std::string::npos) return std::nullopt;
  const auto number = table_number(std::string_view(path).substr(list.size(), dot - list.size()));
  if (!number) return std::nullopt;
  return key_of_table{*number, path.substr(dot + 1)};
}

}  // namespace apsis
