#include <apsis/config/parameter_use.hpp>

#include <apsis/core/suggest.hpp>

#include <algorithm>
#include <cctype>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis {
namespace {

const std::string head_of_parameters = "parameters.";

bool in_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Adds all words of a value. Some are names of constants.
void add_words(const raw_value& raw, std::set<std::string>& words) {
  if (const auto* list = std::get_if<raw_value::list>(&raw.value))
    for (const raw_value& item : *list) add_words(item, words);
  const auto* text = std::get_if<std::string>(&raw.value);
  if (text == nullptr) return;
  for (auto begin = text->begin(); begin != text->end();) {
    begin = std::find_if(begin, text->end(), in_name);
    const auto end = std::find_if_not(begin, text->end(), in_name);
    words.emplace(begin, end);
    begin = end;
  }
}

/// Returns the suggestion for a name. "Mach" leads to "M", which no count of changed letters would.
std::string suggest_parameter(const std::string& name, const std::vector<std::string>& used) {
  if (used.empty()) return "remove it";
  if (nearest_word(name, used).empty())
    for (const std::string& other : used)
      if (name.starts_with(other) || other.starts_with(name)) return suggest(other, used);
  return suggest(name, used);
}

}  // namespace

void check_overridden_parameters(const case_text& text) {
  std::set<std::string> words;
  for (const auto& [path, raw] : text.values)
    if (!path.starts_with(head_of_parameters)) add_words(raw, words);
  std::vector<std::string> used;
  for (const auto& [path, raw] : text.values)
    if (path.starts_with(head_of_parameters) && words.contains(path.substr(head_of_parameters.size())))
      used.push_back(path.substr(head_of_parameters.size()));
  for (const auto& [path, raw] : text.values) {
    const bool overridden =
        path.starts_with(head_of_parameters) && raw.place.line == 0;  // values of a file have lines
    const std::string name = overridden ? path.substr(head_of_parameters.size()) : "";
    if (overridden && !words.contains(name))
      throw input_error(raw.place, fmt::format("no formula uses the parameter '{}' (it changes nothing); {}",
                                               shown(name), suggest_parameter(name, used)));
  }
}

}  // namespace apsis
