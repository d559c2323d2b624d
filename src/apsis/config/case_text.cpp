#include <apsis/config/case_text.hpp>

#include <apsis/core/text_place.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <toml++/toml.h>

namespace apsis {
namespace {

source_place place_of(const toml::source_region& source, const std::string& file) {
  return {file, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

// Both limits reject files that are not cases before they are parsed.
void check_size(std::string_view text, const std::string& file) {
  if (text.size() > longest_case_file)
    throw input_error(
        place_at(text, longest_case_file, file),
        "the file is larger than 1 MB (a case has a few dozen lines); is it the file you meant?");
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end - begin > longest_case_line)
      throw input_error(
          place_at(text, begin + longest_case_line, file),
          fmt::format("the line is longer than {} bytes (a case has short lines); is it the file you meant?",
                      longest_case_line));
    begin = end + 1;
  }
}

/// Converts a value of the key at `place`. If `file` is given, items of a list have their own places in it.
raw_value convert(const toml::node& node, const source_place& place, const std::string& file = "") {
  raw_value raw;
  raw.place = place;
  raw.value_place = file.empty() ? place : place_of(node.source(), file);
  if (const auto* integer = node.as_integer()) {
    raw.value = static_cast<long>(integer->get());
    raw.what = fmt::format("the integer {}", integer->get());
  } else if (const auto* number = node.as_floating_point()) {
    raw.value = number->get();
    raw.what = fmt::format("the number {}", number->get());
  } else if (const auto* text = node.as_string()) {
    raw.value = text->get();
    raw.what = fmt::format("the text '{}'", shown(text->get()));
  } else if (const auto* array = node.as_array()) {
    raw_value::list items;
    for (const auto& item : *array) items.push_back(convert(item, place, file));
    raw.what = fmt::format("a list of {}", items.size());
    raw.value = std::move(items);
  } else if (node.is_boolean()) {
    raw.what = "a boolean";
  } else {
    raw.what = node.is_table() ? "a table" : "a date or time";
  }
  return raw;
}

void add_value(case_text& out, const std::string& path, const toml::key& key, const toml::node& node,
               const std::string& file) {
  out.values.emplace(path, convert(node, place_of(key.source(), file), file));
}

/// Largest depth of nested tables, such as [[initial.region.part]] or shapes of shapes.
constexpr int most_levels = 12;

/// Adds a value, or the values of a table or of a list of tables. Items of a list are numbered from 1:
/// "initial.region.1.T".
void add_nested(case_text& out, const std::string& path, const toml::key& key, const toml::node& node,
                const std::string& file, int levels) {
  const toml::array* list = node.as_array();
  const bool tables = list != nullptr && list->is_array_of_tables();
  if (levels == 0 || (node.as_table() == nullptr && !tables)) return add_value(out, path, key, node, file);
  const auto add_table = [&](const std::string& name, const toml::table& table) {
    out.tables.emplace(name, place_of(table.source(), file));
    for (const auto& [inner, value] : table)
      add_nested(out, fmt::format("{}.{}", name, inner.str()), inner, value, file, levels - 1);
  };
  if (!tables) return add_table(path, *node.as_table());
  for (std::size_t k = 0; k < list->size(); ++k)
    add_table(fmt::format("{}.{}", path, k + 1), *list->get(k)->as_table());
}

std::string in_quotes(const std::string& value) {
  std::string out(1, '"');
  for (const char c : value) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

std::optional<double> decimal(std::string_view text) {
  double x = 0.0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), x);
  if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return x;
}

// Returns the value of a fraction such as "1/128", which is not TOML; nothing if the text is not a fraction
// of decimals.
std::optional<double> fraction(std::string_view value) {
  const auto slash = value.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const auto above = decimal(value.substr(0, slash)), below = decimal(value.substr(slash + 1));
  if (!above || !below) return std::nullopt;
  return *above / *below;
}

// Returns the value of a decimal without digits on one side of its point, ".5" or "1.", which is not TOML.
std::optional<double> bare_decimal(std::string_view value) {
  const auto point = value.find('.');
  if (point == std::string_view::npos || value.find_first_not_of("0123456789+-.eE") != std::string_view::npos)
    return std::nullopt;
  const auto is_digit = [&](std::size_t at) {
    return at < value.size() && value[at] >= '0' && value[at] <= '9';
  };
  if (point > 0 && is_digit(point - 1) && is_digit(point + 1)) return std::nullopt;  // TOML
  if (value.starts_with("+-")) return std::nullopt;
  return decimal(value.substr(value.front() == '+' ? 1 : 0));
}

/// Returns the message about a text that is not TOML; `file` is its path or name.
std::string syntax_message(std::string_view description, const std::string& file) {
  // The parser reports an unclosed quote as a character of the line end, or as the end of the file.
  const bool of_text = description.find("parsing string") != std::string_view::npos;
  const bool unclosed = of_text && (description.find("unescaped control") != std::string_view::npos ||
                                    description.find("end-of-file") != std::string_view::npos);
  const std::string ending = std::filesystem::path(file).extension().string();
  std::string advice = "correct the syntax here";
  if (unclosed) advice = "add the closing quote if it is missing";
  if (!ending.empty() && ending != ".toml") advice = "is it the case file you meant?";
  return fmt::format("not valid TOML ({}); {}", shown(description, 200), advice);
}

}  // namespace

std::string shown(std::string_view text, std::size_t longest) {
  std::string out(text.substr(0, longest));
  // Removes the bytes of a truncated UTF-8 character.
  while (text.size() > longest && !out.empty() &&
         (static_cast<unsigned char>(text[out.size()]) & 0xC0U) == 0x80U)
    out.pop_back();
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = '?';
  return text.size() > longest ? out + "..." : out;
}

const raw_value* case_text::find(const std::string& path) const {
  const auto found = values.find(path);
  return found == values.end() ? nullptr : &found->second;
}

source_place case_text::place_of_missing(const std::string& path, const std::string& file) const {
  const auto found = tables.find(path.substr(0, path.find('.')));
  return found != tables.end() ? found->second : source_place{file, 1, 1};
}

case_text read_case_text(std::string_view text, const std::string& file) {
  check_size(text, file);
  case_text out;
  try {
    const toml::table root = toml::parse(text, file);
    for (const auto& [key, node] : root) {
      const std::string name(key.str());
      const toml::table* table = node.as_table();
      if (table == nullptr) {
        add_value(out, name, key, node, file);
        continue;
      }
      out.tables.emplace(name, place_of(node.source(), file));
      for (const auto& [inner, value] : *table) {
        const std::string path = fmt::format("{}.{}", name, inner.str());
        const bool nested = name == "boundary" || name == "initial" || path == "model.knudsen" ||
                            path == "space.solid" || path == "space.body" || path == "output.probe" ||
                            path == "output.slice" || path == "output.reference";
        add_nested(out, path, inner, value, file, nested ? most_levels : 0);
      }
    }
  } catch (const toml::parse_error& e) {
    throw input_error(place_of(e.source(), file), syntax_message(e.description(), file));
  }
  return out;
}

void apply_override(case_text& target, const std::string& path, const std::string& value,
                    const override_form& form, const source_place& place) {
  if (value.find_first_of("\r\n") != std::string::npos)
    throw input_error(place, "the value has more than one line (one value is needed); give one line");
  if (value.size() > longest_case_line)
    throw input_error(place, fmt::format("the value has {} bytes (at most {} are read); shorten it",
                                         value.size(), longest_case_line));
  const auto take = [&](const std::optional<double>& number, const char* kind) {
    if (number) target.values[path] = {*number, fmt::format("the {} {}", kind, value), place, place};
    return number.has_value();
  };
  if (!form.is_text && (take(fraction(value), "fraction") || take(bare_decimal(value), "number"))) return;
  const bool bare = form.is_text && value.find_first_of("\"'") != 0;
  const std::string line = "value = " + (bare ? in_quotes(value) : value);
  try {
    const toml::table root = toml::parse(line);
    // TOML would treat the rest as a comment.
    if (!bare && value.find_first_of("#\"'") != std::string::npos &&
        value[value.find_first_of("#\"'")] == '#')
      throw input_error(place, "the value is followed by '#' (comments are for files); remove the comment");
    target.values[path] = convert(*root.get("value"), place);
  } catch (const toml::parse_error& e) {
    throw input_error(place, value.empty() ? fmt::format("the value is empty (nothing stands behind '='); {}",
                                                         form.suggestion)
                                           : fmt::format("'{}' is not a value of TOML ({}); {}", shown(value),
                                                         shown(e.description(), 200), form.suggestion));
  }
}

}  // namespace apsis
