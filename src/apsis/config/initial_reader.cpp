#include <apsis/config/initial_reader.hpp>

#include <apsis/config/case_value.hpp>
#include <apsis/config/list_of_tables.hpp>
#include <apsis/config/suggest_variable.hpp>

#include <algorithm>
#include <optional>

#include <fmt/format.h>

namespace apsis {
namespace {

std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    parts.push_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

class reader_of_initial_state {
 public:
  reader_of_initial_state(const case_text& text, const model& equation, const std::string& name)
      : text_(text), model_name_(name) {
    for (const auto& form : equation.data_forms())
      for (const auto& variable : form.variables) variables_.push_back(variable.name);
  }

  initial_table read(const formula_constants& constants) {
    constants_ = &constants;
    for (const auto& [path, raw] : text_.values) {
      if (path.rfind("initial.", 0) != 0) continue;
      if (variables_.empty())
        throw input_error(raw.place, fmt::format("key '{}' is not used (model '{}' has only named data); "
                                                 "write model.initial",
                                                 shown(path), model_name_));
      take(path, parts_of(path), raw);
    }
    check_source();
    return std::move(table_);
  }

 private:
  using words = std::vector<std::string>;

  void take(const std::string& path, const words& key, const raw_value& raw) {
    if (key.size() == 2 && !is_variable(key[1]) && take_source(path, key[1], raw)) return;
    if (key.size() == 2)
      return take_variable(path, key[1], raw, table_.state, {"part", "region", "file", "time"});
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

  bool is_variable(const std::string& name) const {
    return std::find(variables_.begin(), variables_.end(), name) != variables_.end();
  }

  /// Reads a key of data that are not in the case. Returns false for other keys.
  bool take_source(const std::string& path, const std::string& name, const raw_value& raw) {
    const auto* text = std::get_if<std::string>(&raw.value);
    if (name == "file") {
      if (text == nullptr || text->empty())
        refuse(raw, path, "it must be a text", "write for example file = \"results/earlier/solution.h5\"");
      table_.file = *text;
    } else if (name == "from") {
      if (text == nullptr || *text != "python")
        refuse(raw, path, "it must be \"python\"", "remove it, or write file = \"…\" for data of a file");
      table_.from_python = true;
    } else if (name == "time") {
      const expression value(formula_texts(raw, path).front(), raw.value_place,
                             formula_of_position(0, false, *constants_));
      if (!value.is_constant()) refuse(raw, path, "it depends on x", "give a number");
      table_.time = value.evaluate(position{});
    } else {
      return false;
    }
    return true;
  }

  /// Checks that the data come from one place.
  void check_source() const {
    const raw_value* time = find("initial.time");
    if (time != nullptr && table_.time && table_.file.empty())
      throw input_error(
          time->place,
          "'initial.time' has no meaning (it is the time of a snapshot in initial.file, which is "
          "not given); add file = \"results/earlier/solution.h5\", or remove it");
    if (!table_.given_elsewhere()) return;
    const char* source = table_.file.empty() ? "initial.from" : "initial.file";
    if (table_.from_python && (!table_.file.empty() || !table_.regions.empty()))
      throw input_error(find("initial.from")->place,
                        "'initial.from' conflicts with the rest of [initial] (the data are given in Python); "
                        "remove one of them");
    for (const auto& [path, raw] : text_.values) {
      if (path.rfind("initial.", 0) != 0 || path.rfind("initial.region.", 0) == 0 || path == source ||
          (path == "initial.time" && !is_variable("time")))
        continue;
      throw input_error(raw.place, fmt::format("'{}' conflicts with '{}' (both give the state); remove one "
                                               "of them, or move it into [[initial.region]]",
                                               path, source));
    }
  }

  const raw_value* find(const std::string& path) const {
    const auto found = text_.values.find(path);
    return found == text_.values.end() ? nullptr : &found->second;
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
    const auto number = table_number(key[at]);
    if (!number || key.size() < at + 2)
      throw input_error(
          raw.place, fmt::format("unknown key '{}' ({} is a list of tables, numbered from 1 to at most {}); "
                                 "write [[initial.{}]], or on the command line initial.{}.1.T=2",
                                 shown(path), key[at - 1], most_listed_tables, key[at - 1], key[at - 1]));
    if (items.size() < *number) items.resize(*number);
    return items[*number - 1];
  }

  [[noreturn]] void unknown(const std::string& path, const raw_value& raw, const std::string& word,
                            const words& others) const {
    words valid = variables_;
    valid.insert(valid.end(), others.begin(), others.end());
    std::sort(valid.begin(), valid.end());
    valid.erase(std::unique(valid.begin(), valid.end()), valid.end());
    throw input_error(raw.place, fmt::format("unknown key '{}' (no such variable of model '{}'); {}",
                                             shown(path), model_name_, suggest_variable(word, valid)));
  }

  const case_text& text_;
  std::string model_name_;
  words variables_;
  const formula_constants* constants_ = nullptr;
  initial_table table_;
};

}  // namespace

initial_table read_initial_table(const case_text& text, const model& equation, const std::string& name,
                                 const formula_constants& constants) {
  return reader_of_initial_state(text, equation, name).read(constants);
}

}  // namespace apsis
