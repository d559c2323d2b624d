#include <apsis/method/method_text.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/text_file.hpp>
#include <apsis/core/text_place.hpp>
#include <apsis/method/method_file.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include <fmt/format.h>

namespace apsis {
namespace {

constexpr std::size_t longest_file = 1 << 20;  ///< bytes; the largest method of 64 stages needs a
                                               ///< fifth of that
constexpr std::size_t most_key_parts = 8;      ///< keys of a method file have one part
constexpr std::size_t most_nested = 8;         ///< its values are lists of lists at most

/// Returns the position after the quoted string that begins at `begin`; the end of its line if the string
/// is not terminated.
std::size_t after_quotes(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const std::string_view three = text.substr(begin, 3);
  const bool many_lines = three == std::string(3, quote);
  std::size_t at = begin + (many_lines ? 3 : 1);
  for (; at < text.size(); ++at) {
    if (text[at] == '\\' && quote == '"') {
      ++at;
    } else if (many_lines) {
      if (text.substr(at, 3) == three) return at + 3;
    } else if (text[at] == quote) {
      return at + 1;
    } else if (text[at] == '\n') {
      return at;
    }
  }
  return text.size();
}

/// Throws input_error for a key of too many parts or too deeply nested values. Outside strings and comments,
/// a '.' separates parts of a key or is the only point of a number.
void check_depth(std::string_view text, const std::string& file) {
  std::size_t parts = 1, nested = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '#') {
      at = std::min(text.find('\n', at), text.size());
      parts = 1;
    } else if (c == '"' || c == '\'') {
      at = after_quotes(text, at) - 1;
    } else if (c == '[' || c == '{') {
      parts = 1;
      if (++nested > most_nested)
        throw input_error(place_at(text, at, file),
                          fmt::format("values are nested deeper than {} lists or tables (a method file has "
                                      "lists of lists); is it the file you meant?",
                                      most_nested));
    } else if (c == ']' || c == '}') {
      parts = 1;
      nested -= nested > 0 ? 1 : 0;
    } else if (c == '=' || c == ',' || c == '\n') {
      parts = 1;
    } else if (c == '.' && ++parts > most_key_parts) {
      throw input_error(place_at(text, at, file),
                        fmt::format("the key has more than {} parts (keys of a method file have one, tables "
                                    "like [claims] too); is it the file you meant?",
                                    most_key_parts));
    }
  }
}

bool is_letter_or_digit(char c) {
  return static_cast<unsigned char>(c) < 128 && std::isalnum(static_cast<unsigned char>(c)) != 0;
}

}  // namespace

void check_method_text(std::string_view text, const std::string& file) {
  if (text.size() > longest_file)
    throw input_error(place_at(text, longest_file, file),
                      fmt::format("the file is larger than {} bytes (a method file never is); is it the "
                                  "file you meant?",
                                  longest_file));
  check_depth(text, file);
}

std::string method_name_problem(std::string_view name) {
  constexpr std::size_t longest_name = 60;
  const std::string rule = fmt::format(
      "give 1 to {} letters, digits, '-', '_', '+' or '.', beginning with a letter or digit", longest_name);
  if (name.empty()) return fmt::format("the name is empty (results are filed under it); {}", rule);
  if (name.size() > longest_name)
    return fmt::format("the name is too long ({} characters, at most {}); {}", name.size(), longest_name,
                       rule);
  const auto allowed = [](char c) {
    return is_letter_or_digit(c) || c == '-' || c == '_' || c == '+' || c == '.';
  };
  if (!is_letter_or_digit(name.front()) || !std::all_of(name.begin(), name.end(), allowed))
    return fmt::format("the name cannot be used (files are named after the method); {}", rule);
  if (is_method_file(name)) return "the name ends in '.toml' (that would be a file); leave the ending out";
  return "";
}

std::string read_method_text(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw input_error(
        fmt::format("cannot read the method file '{}' (it does not exist); check the path", path));
  return read_text_file(path, longest_file, "method file");
}

}  // namespace apsis
