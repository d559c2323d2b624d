#pragma once

#include <apsis/core/errors.hpp>

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace apsis {

/// An untyped value of a case file. `std::monostate` stands for types that no key has (boolean, date, nested
/// table).
struct raw_value {
  using list = std::vector<raw_value>;                                  ///< an array of TOML
  std::variant<std::monostate, long, double, std::string, list> value;  ///< value in TOML
  std::string what;          ///< description for messages: "the integer 5", "a boolean"
  source_place place;        ///< place of the key or override; of the key for list elements
  source_place value_place;  ///< place of the value, or of the list element
};

/// Keys of a case by dotted path, and places of its tables. Items of a list of tables are numbered from 1.
struct case_text {
  std::map<std::string, raw_value> values;     ///< by path, "space.cells"
  std::map<std::string, source_place> tables;  ///< by dotted name, "space", "initial.region.1"

  /// Returns the value of a key; nothing if the case does not give it.
  const raw_value* find(const std::string& path) const;
  /// Returns the place for a message about a missing key of `file`: the head of its table, or the first line.
  source_place place_of_missing(const std::string& path, const std::string& file) const;
};

constexpr std::size_t longest_case_file = 1'000'000;  ///< bytes
constexpr std::size_t longest_case_line = 4096;       ///< bytes; bounds the depth of dotted keys as well

/// Reads TOML into flat keys. Throws input_error with line and column if the text is too large or not TOML.
case_text read_case_text(std::string_view text, const std::string& file);

/// Syntax of an override: whether its key takes text, and the suggestion if its value is not TOML.
struct override_form {
  bool is_text = false;                                      ///< quotes are optional
  std::string suggestion = "write a number, or \"a text\"";  ///< "write for example [0.0, 2.0]"
};

/// Sets one key from "dotted.key=value". The value is TOML, but text may stand without quotes. A number may
/// be a fraction like 1/128, or lack digits on one side of its point, as .5 does. Throws input_error.
void apply_override(case_text& target, const std::string& path, const std::string& value,
                    const override_form& form, const source_place& place);

/// Returns user text for a message: at most `longest` bytes, control characters replaced by '?'.
std::string shown(std::string_view text, std::size_t longest = 60);

}  // namespace apsis
