#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/core/matrix.hpp>

#include <cstddef>
#include <string>
#include <vector>

#include <toml++/toml.h>

namespace apsis {

inline constexpr std::size_t most_stages = 64;  ///< largest number of stages of a method file

/// Returns the place of a TOML node.
source_place place_of(const toml::node& node, const std::string& file);

/// Typed reader of a table of a method file. Every function throws input_error with the place of the value
/// if the key is missing or its value is invalid.
class toml_section {
 public:
  /// The table called `name` in messages ("" at the top level). Throws input_error if it has a key that is
  /// not among `keys`.
  toml_section(const toml::table& table, std::string file, std::string name,
               const std::vector<std::string>& keys);

  /// Whether the table has the key.
  bool has(const std::string& key) const { return table_.contains(key); }
  /// Returns the node of a required key.
  const toml::node& need(const std::string& key) const;
  /// Returns a string of at most 500 characters.
  std::string text(const std::string& key) const;
  /// Returns an integer in [lowest, highest].
  int integer(const std::string& key, int lowest, int highest) const;
  /// Returns true or false.
  bool boolean(const std::string& key) const;
  /// Returns a coefficient as text, "p/q" or a decimal.
  std::string coefficient(const std::string& key) const { return coefficient_of(need(key), key); }
  /// Returns a list of coefficients.
  std::vector<std::string> vector(const std::string& key) const { return row(need(key), key); }
  /// Reads the rows of a lower triangular matrix into m. Row i = 1, 2, … has i − 1 + diagonal entries, or one
  /// per stage with trailing zeros.
  void triangle(const std::string& key, std::size_t diagonal, matrix<std::string>& m) const;
  /// Returns the number of rows of a matrix, from 1 to most_stages.
  std::size_t row_count(const std::string& key) const;
  /// Throws input_error at the value of a key.
  [[noreturn]] void fail(const std::string& key, const std::string& problem) const;

 private:
  std::string inside() const { return name_.empty() ? "" : " in [" + name_ + "]"; }
  std::string quoted(const std::string& key) const {
    return "'" + (name_.empty() ? key : name_ + "." + key) + "'";
  }
  [[noreturn]] void wrong(const toml::node& node, const std::string& key, const std::string& expected,
                          const std::string& example) const;
  std::string coefficient_of(const toml::node& node, const std::string& key) const;
  std::vector<std::string> row(const toml::node& node, const std::string& what) const;

  const toml::table& table_;
  std::string file_, name_;
};

/// Returns a required table of the root. Throws input_error if it is missing or not a table.
const toml::table& need_table(const toml::table& root, const std::string& key, const std::string& file);

}  // namespace apsis
