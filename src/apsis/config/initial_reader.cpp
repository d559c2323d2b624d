#include <apsis/config/initial_reader.hpp>

#include <apsis/config/case_value.hpp>
#include <apsis/core/suggest.hpp>

#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>

namespace apsis {
namespace {

constexpr int most_items = 1000;  ///< of a list of tables

std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    parts.push_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

class reader {
 public:
  reader(const case_text& text, const model& equation, const std::string& name)
      : text_(text), model_name_(name) {
    for (const auto& form : equation.data_forms())
      for (const auto& variable : form.variables) variables_.push_back(variable.name);
  }

  initial_table read() {
    for (const auto& [path, raw] : text_.values) {
      if (path.rfind("initial.", 0) != 0) continue;
      if (variables_.empty())
        throw input_error(raw.place, fmt::format("key '{}' is not used (model '{}' has only named data); "
                                                 "write model.initial",
                                                 shown(path), model_name_));
      take(path, parts_of(path), raw);
    }
    return std::move(table_);
  }

 private:
  using words = std::vector<std::string>;

  void take(const std::string& path, const words& key, const raw_value& raw) {
    if (key.size() == 2) return take_variable(path, key[1], raw, table_.state, {"part", "region"});
    if (key[1] == "part") return take_part(path, key, 2, raw, table_.parts);
    if (key[1] != "region") unknown(path, raw, key[1], {"part", "region"});
    initial_region& region = item(path, key, 2, raw, table_.regions);
    if (key.size() == 4 && key[3] == "where") {
      region.where = formula_texts(raw, path).front();
    } else if (key.size() == 4) {
      take_variable(path, key[3], raw, region.state, {"where", "part"});
    } else {
      if (key[3] != "part") unknown(path, raw, key[3], {"where", "part"});
      take_part(path, key, 4, raw, region.parts);
    }
  }

  void take_part(const std::string& path, const words& key, std::size_t at, const raw_value& raw,
                 std::vector<initial_part>& parts) {
    initial_part& part = item(path, key, at, raw, parts);
    if (key.size() != at + 2) unknown(path, raw, key[at + 1], {"weight"});
    if (key[at + 1] == "weight") {
      part.weight = formula_texts(raw, path).front();
    } else {
      take_variable(path, key[at + 1], raw, part.state, {"weight"});
    }
  }

  void take_variable(const std::string& path, const std::string& name, const raw_value& raw,
                     state_formulas& state, const words& others) {
    if (std::find(others.begin(), others.end(), name) != others.end())
      refuse(raw, path, "it is a list of tables", fmt::format("write [[{}]]", path));
    if (std::find(variables_.begin(), variables_.end(), name) == variables_.end())
      unknown(path, raw, name, others);
    state[name] = formula_texts(raw, path);
  }

  /// Returns the item whose number, from 1, is the word `at` of the key.
  template <class Item>
  Item& item(const std::string& path, const words& key, std::size_t at, const raw_value& raw,
             std::vector<Item>& items) {
    int number = 0;
    const char* end = key[at].data() + key[at].size();
    const auto [stop, problem] = std::from_chars(key[at].data(), end, number);
    if (problem != std::errc() || stop != end || number < 1 || number > most_items || key.size() < at + 2)
      throw input_error(
          raw.place, fmt::format("unknown key '{}' ({} is a list of tables, numbered from 1 to at most {}); "
                                 "write [[initial.{}]], or on the command line initial.{}.1.T=2",
                                 shown(path), key[at - 1], most_items, key[at - 1], key[at - 1]));
    const auto index = static_cast<std::size_t>(number);
    if (items.size() < index) items.resize(index);
    return items[index - 1];
  }

  [[noreturn]] void unknown(const std::string& path, const raw_value& raw, const std::string& word,
                            const words& others) const {
    words valid = variables_;
    valid.insert(valid.end(), others.begin(), others.end());
    std::sort(valid.begin(), valid.end());
    valid.erase(std::unique(valid.begin(), valid.end()), valid.end());
    throw input_error(raw.place, fmt::format("unknown key '{}' (no such variable of model '{}'); {}",
                                             shown(path), model_name_, suggest(word, valid)));
  }

  const case_text& text_;
  std::string model_name_;
  words variables_;
  initial_table table_;
};

}  // namespace

initial_table read_initial_table(const case_text& text, const model& equation, const std::string& name) {
  return reader(text, equation, name).read();
}

}  // namespace apsis
