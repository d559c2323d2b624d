#include <apsis/method/internal/toml_section.hpp>

#include <apsis/core/suggest.hpp>
#include <apsis/method/coefficient.hpp>

#include <algorithm>

#include <fmt/format.h>

namespace apsis {
namespace {

constexpr std::size_t longest_text = 500;

}  // namespace

source_place place_of(const toml::node& node, const std::string& file) {
  const auto& begin = node.source().begin;
  return {file, static_cast<int>(begin.line), static_cast<int>(begin.column)};
}

toml_section::toml_section(const toml::table& table, std::string file, std::string name,
                           const std::vector<std::string>& keys)
    : table_(table), file_(std::move(file)), name_(std::move(name)) {
  for (const auto& [key, value] : table) {
    const std::string text(key.str());
    if (std::find(keys.begin(), keys.end(), text) != keys.end()) continue;
    const auto& at = key.source().begin;
    throw input_error(
        {file_, static_cast<int>(at.line), static_cast<int>(at.column)},
        fmt::format("unknown key '{}'{} ({} has no such key); {}", text.substr(0, 60), inside(),
                    name_.empty() ? "a method file" : "the table of this method", suggest(text, keys)));
  }
}

const toml::node& toml_section::need(const std::string& key) const {
  const toml::node* node = table_.get(key);
  if (node == nullptr)
    throw input_error(place_of(table_, file_),
                      fmt::format("missing key '{}'{} (it is required); add it", key, inside()));
  return *node;
}

std::string toml_section::text(const std::string& key) const {
  const toml::node& node = need(key);
  const auto value = node.value<std::string>();
  if (!node.is_string() || !value) wrong(node, key, "a string in quotes", "\"text\"");
  if (value->size() > longest_text)
    throw input_error(place_of(node, file_),
                      fmt::format("{} is too long ({} characters, at most {}); shorten it", quoted(key),
                                  value->size(), longest_text));
  return *value;
}

int toml_section::integer(const std::string& key, int lowest, int highest) const {
  const toml::node& node = need(key);
  const auto value = node.value<std::int64_t>();
  if (!node.is_integer() || !value) wrong(node, key, "an integer", "2");
  if (*value < lowest || *value > highest)
    throw input_error(place_of(node, file_),
                      fmt::format("{} = {} is out of range (from {} to {}); give a number in this range",
                                  quoted(key), *value, lowest, highest));
  return static_cast<int>(*value);
}

bool toml_section::boolean(const std::string& key) const {
  const toml::node& node = need(key);
  const auto value = node.value_exact<bool>();
  if (!value) wrong(node, key, "true or false", "true");
  return *value;
}

std::vector<std::string> toml_section::row(const toml::node& node, const std::string& what) const {
  const toml::array* array = node.as_array();
  if (array == nullptr) wrong(node, what, "a list of coefficients", "[\"1/2\", \"0\"]");
  if (array->size() > most_stages)
    throw input_error(place_of(node, file_),
                      fmt::format("{} has {} entries (a method has at most {} stages); leave some out",
                                  quoted(what), array->size(), most_stages));
  std::vector<std::string> values;
  for (const toml::node& entry : *array) values.push_back(coefficient_of(entry, what));
  return values;
}

void toml_section::triangle(const std::string& key, std::size_t diagonal, matrix<std::string>& m) const {
  const toml::node& node = need(key);
  const toml::array* rows = node.as_array();
  if (rows == nullptr) wrong(node, key, "a list of rows", "[[], [\"1\"]]");
  if (rows->size() != m.rows())
    throw input_error(place_of(node, file_),
                      fmt::format("{} has {} rows (the method has {} stages); give one row per stage",
                                  quoted(key), rows->size(), m.rows()));
  for (std::size_t i = 0; i < m.rows(); ++i) {
    const toml::node& line = *rows->get(i);
    const auto values = row(line, key);
    const std::size_t expected = i + diagonal;
    if (values.size() != expected && values.size() != m.rows())
      throw input_error(place_of(line, file_),
                        fmt::format("row {} of {} has {} entries (the matrix is lower triangular); give {}",
                                    i + 1, quoted(key), values.size(), expected));
    for (std::size_t j = 0; j < values.size(); ++j) {
      if (j < expected) {
        m(i, j) = values[j];
      } else if (coefficient_value(values[j]) != 0) {
        throw input_error(place_of(*line.as_array()->get(j), file_),
                          fmt::format("entry {} of row {} of {} lies above the triangle (a stage cannot "
                                      "use a later one); give \"0\" or leave it out",
                                      j + 1, i + 1, quoted(key)));
      }
    }
  }
}

std::size_t toml_section::row_count(const std::string& key) const {
  const toml::node& node = need(key);
  const toml::array* rows = node.as_array();
  if (rows == nullptr || rows->empty() || rows->size() > most_stages)
    throw input_error(
        place_of(node, file_),
        fmt::format("{} is not a list of 1 to {} stages (each stage is a row); give one row per stage",
                    quoted(key), most_stages));
  return rows->size();
}

void toml_section::fail(const std::string& key, const std::string& problem) const {
  throw input_error(place_of(need(key), file_), problem);
}

void toml_section::wrong(const toml::node& node, const std::string& key, const std::string& expected,
                         const std::string& example) const {
  throw input_error(place_of(node, file_),
                    fmt::format("{} has the wrong type ({} is needed); write for example {}", quoted(key),
                                expected, example));
}

std::string toml_section::coefficient_of(const toml::node& node, const std::string& key) const {
  const auto value = node.value<std::string>();
  if (!node.is_string() || !value)
    wrong(node, key, "a coefficient in quotes", "\"1/2\" or \"0.25\", so that no digit is lost");
  if (!is_coefficient(*value))
    throw input_error(place_of(node, file_),
                      fmt::format("'{}' is not a coefficient (for {}); write an exact rational \"p/q\" or a "
                                  "decimal of at most 200 characters",
                                  value->substr(0, 40), quoted(key)));
  return *value;
}

const toml::table& need_table(const toml::table& root, const std::string& key, const std::string& file) {
  const toml::node* node = root.get(key);
  if (node == nullptr)
    throw input_error(source_place{file, 1, 1},
                      fmt::format("missing table [{}] (it is required); add it", key));
  if (node->as_table() == nullptr)
    throw input_error(place_of(*node, file),
                      fmt::format("'{0}' is not a table (its keys are those of a table); write [{0}]", key));
  return *node->as_table();
}

}  // namespace apsis
