#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace apsis {

/// Largest number of a table in a list of tables.
constexpr int most_listed_tables = 1000;

/// A key of a table in a list: "radius" of the second table for "space.body.2.radius".
struct key_of_table {
  std::size_t number = 0;  ///< number of the table, from 1
  std::string key;         ///< the rest of the path
};

/// Returns the number of a table that a word of a path gives, from 1 to most_listed_tables; nothing for other
/// words.
std::optional<std::size_t> table_number(std::string_view word);

/// Splits a path that begins with the list, as in split_key("space.body.2.radius", "space.body."). Returns
/// nothing unless the number of a table and a key follow.
std::optional<key_of_table> split_key(const std::string& path, std::string_view list);

}  // namespace apsis
