#include <apsis/config/case_value.hpp>

#include <apsis/config/at_place.hpp>
#include <apsis/config/quantity.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/model/expression.hpp>
#include <apsis/model/number_tuples.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {

std::string type_advice(key_type type) {
  switch (type) {
    case key_type::integer:
      return "write for example 100";
    case key_type::number:
      return "write for example 0.5";
    case key_type::text:
      return "put it in quotes";
    case key_type::quantity:
      return "write for example \"10 Pa\"";
    case key_type::formula:
      return "write for example 1e-3 or \"1e-3 + x^2\"";
    case key_type::text_list:
      return "write for example [\"rho\", \"u\"]";
    case key_type::formulas:
      return "write for example [0, \"0.1*sin(t)\"]";
    case key_type::integers:
      return "write for example 100, or [100, 50] in two dimensions";
    case key_type::intervals:
      return "write for example [0.0, 2.0], or [[0.0, 2.0], [0.0, 1.0]] in two dimensions";
    case key_type::points:
      return "write for example [[0.5], [0.7]], or [[0.5, 0.2], [0.7, 0.2]] in two dimensions";
  }
  return "";
}

void refuse(const raw_value& raw, const std::string& path, const std::string& why,
            const std::string& advice) {
  throw input_error(raw.place, fmt::format("'{}' is {} ({}); {}", path, raw.what, why, advice));
}

double finite_number(const raw_value& raw, const std::string& path, const std::string& needed) {
  double x = 0.0;
  if (const auto* integer = std::get_if<long>(&raw.value))
    x = static_cast<double>(*integer);
  else if (const auto* real = std::get_if<double>(&raw.value))
    x = *real;
  else
    refuse(raw, path, needed + " is needed", type_advice(key_type::number));
  if (!std::isfinite(x)) refuse(raw, path, "it must be finite", "give a finite number");
  return x;
}

namespace {

/// Returns the suggestion for a value that should be a text, one of `names` unless there are none.
std::string advice_for_text(const raw_value& raw, const std::string& path,
                            const std::vector<std::string>& names) {
  const bool several = raw.what == "a table" || std::holds_alternative<raw_value::list>(raw.value);
  if (several && path == "space.boundary")
    return "give one kind in quotes, or a table for each face, such as [boundary.left]";
  if (!names.empty()) return fmt::format("write a name in quotes, valid: {}", fmt::join(names, ", "));
  return several ? "write one text in quotes" : type_advice(key_type::text);
}

void check_range(const case_key& key, const raw_value& raw, double x) {
  const bool low = key.lowest_excluded ? x > key.lowest : x >= key.lowest;
  if (!low || x > key.highest)
    refuse(raw, key.path, "it must be " + range_text(key), "change it to a value in this range");
}

long integer(const case_key& key, const raw_value& raw) {
  if (const auto* whole = std::get_if<long>(&raw.value)) {
    check_range(key, raw, static_cast<double>(*whole));
    return *whole;
  }
  if (!std::holds_alternative<double>(raw.value))
    refuse(raw, key.path, type_text(key_type::integer) + " is needed", type_advice(key_type::integer));
  // "1e3", "40.0" and "80/2" are integers.
  const double x = finite_number(raw, key.path, type_text(key_type::integer));
  if (x != std::floor(x))
    refuse(raw, key.path, type_text(key_type::integer) + " is needed",
           fmt::format("write for example {}", std::clamp(std::round(x), key.lowest, key.highest)));
  check_range(key, raw, x);
  return static_cast<long>(x);  // ranges of integers are far below 2^53
}

double number(const case_key& key, const raw_value& raw, const std::string& path) {
  const double x = finite_number(raw, path, type_text(key_type::number));
  check_range(key, raw, x);
  return x;
}

void check_choice(const case_key& key, const raw_value& raw, const case_config& so_far) {
  if (!key.choices) return;
  const auto names = key.choices(so_far);
  const auto& name = std::get<std::string>(raw.value);
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  const auto why_not = !key.also ? std::nullopt : key.also(name);
  if (!why_not) refuse(raw, key.path, "there is no such name", suggest(name, names));
  if (!why_not->empty()) refuse(raw, key.path, *why_not, "change S");
}

std::string formula(const case_key& key, const raw_value& raw) {
  if (const auto* text = std::get_if<std::string>(&raw.value)) return *text;
  if (std::holds_alternative<long>(raw.value) || std::holds_alternative<double>(raw.value))
    return fmt::format("{}", number(key, raw, key.path));
  refuse(raw, key.path, type_text(key.type) + " is needed", type_advice(key.type));
}

std::string positive_quantity(const case_key& key, const raw_value& raw) {
  const auto* text = std::get_if<std::string>(&raw.value);
  const std::string unit = unit_of(key.dimension);
  if (text == nullptr || !looks_like_quantity(*text))
    refuse(raw, key.path, "a number, a space and a unit are needed",
           fmt::format("write for example \"1 {}\"", unit));
  const quantity given = parse_quantity(*text, raw.place);
  if (given.unit != key.dimension)
    refuse(raw, key.path, fmt::format("its unit is that of {}", unit_of(given.unit)),
           fmt::format("give it in {}", unit));
  if (!(given.value > 0.0)) refuse(raw, key.path, "it must be above 0", "give a positive number");
  return *text;
}

std::vector<std::string> texts(const case_key& key, const raw_value& raw) {
  std::vector<std::string> out;
  if (const auto* one = std::get_if<std::string>(&raw.value)) return {*one};
  const auto* items = std::get_if<raw_value::list>(&raw.value);
  if (items == nullptr) refuse(raw, key.path, type_text(key.type) + " is needed", type_advice(key.type));
  for (const auto& item : *items) {
    if (!std::holds_alternative<std::string>(item.value))
      refuse(item, key.path, type_text(key.type) + " is needed", type_advice(key.type));
    out.push_back(std::get<std::string>(item.value));
  }
  return out;
}

/// Returns the items of a list with one item per direction, at most three; nullptr if it is not a list.
const raw_value::list* directions(const case_key& key, const raw_value& raw) {
  const auto* items = std::get_if<raw_value::list>(&raw.value);
  if (items != nullptr && (items->empty() || items->size() > 3))
    refuse(raw, key.path, type_text(key.type) + " is needed", type_advice(key.type));
  return items;
}

std::vector<long> integers(const case_key& key, const raw_value& raw) {
  const auto* items = directions(key, raw);
  if (items == nullptr) return {integer(key, raw)};
  std::vector<long> out;
  for (const auto& item : *items) out.push_back(integer(key, item));
  return out;
}

interval one_interval(const case_key& key, const raw_value& raw) {
  const auto* items = std::get_if<raw_value::list>(&raw.value);
  if (items == nullptr || items->size() != 2)
    refuse(raw, key.path, type_text(key.type) + " is needed", type_advice(key.type));
  return {finite_number((*items)[0], key.path, type_text(key.type)),
          finite_number((*items)[1], key.path, type_text(key.type))};
}

std::vector<interval> intervals(const case_key& key, const raw_value& raw) {
  const auto* items = std::get_if<raw_value::list>(&raw.value);
  const bool nested =
      items != nullptr && !items->empty() && std::holds_alternative<raw_value::list>(items->front().value);
  if (!nested) return {one_interval(key, raw)};
  std::vector<interval> out;
  for (const auto& item : *directions(key, raw)) out.push_back(one_interval(key, item));
  return out;
}

std::vector<std::vector<double>> points(const case_key& key, const raw_value& raw) {
  const auto* items = std::get_if<raw_value::list>(&raw.value);
  if (items == nullptr) refuse(raw, key.path, type_text(key.type) + " is needed", type_advice(key.type));
  std::vector<std::vector<double>> out;
  for (const auto& item : *items) {
    const auto* coordinates = std::get_if<raw_value::list>(&item.value);
    if (coordinates == nullptr)
      refuse(raw, key.path, type_text(key.type) + " is needed", type_advice(key.type));
    std::vector<double>& x = out.emplace_back();
    for (const auto& one : *coordinates) x.push_back(finite_number(one, key.path, type_text(key.type)));
  }
  return out;
}

}  // namespace

std::string to_text(const model_option& text, const raw_value& raw, const formula_constants& constants) {
  const std::string path = "model." + text.name;
  const auto* value = std::get_if<std::string>(&raw.value);
  if (value == nullptr)
    refuse(raw, path, "a text is needed",
           advice_for_text(raw, path, text.variable.empty() ? text.choices : std::vector<std::string>{}));
  if (std::find(text.choices.begin(), text.choices.end(), *value) != text.choices.end()) return *value;
  const std::string advice = suggest(*value, text.choices);
  if (text.variable.empty()) refuse(raw, path, "there is no such name", advice);
  source_place place = raw.value_place;
  if (place.column > 0) ++place.column;  // after the quotation mark
  try {
    const expression formula(*value, place, formula_kind{{text.variable}, false, constants});
  } catch (const input_error&) {
    // A single word is more likely a misspelled name than a formula.
    const auto in_word = [](char c) {
      return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
    };
    if (!value->empty() && std::all_of(value->begin(), value->end(), in_word))
      refuse(raw, path, fmt::format("it is neither a name nor a formula in {}", text.variable), advice);
    throw;
  }
  return *value;
}

namespace {

/// Throws input_error unless the names can be variables of formulas, of the table [initial] and of
/// boundaries.
void check_names(const raw_value& raw, const std::string& path, const std::vector<std::string>& names,
                 const formula_constants& constants) {
  std::string why = why_not_variables(names, constants);
  for (const char* key : {"kind", "part", "region", "weight", "where"})
    if (why.empty() && std::find(names.begin(), names.end(), key) != names.end())
      why = fmt::format("'{}' cannot be the name of a variable: it is a key of other tables", key);
  if (!why.empty()) refuse(raw, path, shown(why, 200), "choose other names");
}

}  // namespace

namespace {

std::string formula_text(const raw_value& raw, const std::string& path) {
  if (const auto* text = std::get_if<std::string>(&raw.value)) return *text;
  if (std::holds_alternative<long>(raw.value) || std::holds_alternative<double>(raw.value))
    return fmt::format("{}", finite_number(raw, path, "a number"));
  refuse(raw, path, "a number or a formula is needed", "write for example \"1 + 0.2*sin(pi*x)\"");
}

/// Returns lists of numbers and formulas of constants as texts, such as "1, 0".
std::vector<std::string> to_tuples(const std::string& path, const raw_value& raw,
                                   const formula_constants& constants) {
  const auto* items = std::get_if<raw_value::list>(&raw.value);
  const std::string advice = "write for example [[1, 0], [0.5, \"sqrt(3)/2\"]]";
  if (items == nullptr) refuse(raw, path, "a list of lists of numbers is needed", advice);
  std::vector<std::string> tuples;
  for (const raw_value& item : *items) {
    std::string& text = tuples.emplace_back();
    if (const auto* numbers = std::get_if<raw_value::list>(&item.value)) {
      for (const raw_value& one : *numbers) text += (text.empty() ? "" : ", ") + formula_text(one, path);
    } else if (const auto* given = std::get_if<std::string>(&item.value)) {
      text = *given;
    } else {
      refuse(item, path, "a list of lists of numbers is needed", advice);
    }
    if (text.empty()) refuse(item, path, "it is an empty list", advice);
    at_place(item.place, [&] { return number_tuples({text}, constants); });
  }
  return tuples;
}

}  // namespace

std::vector<std::string> to_list(const model_list& list, const raw_value& raw,
                                 const std::vector<std::string>& variables,
                                 const formula_constants& constants) {
  const std::string path = "model." + list.name;
  if (list.tuples) return to_tuples(path, raw, constants);
  const auto* items = std::get_if<raw_value::list>(&raw.value);
  if (items == nullptr)
    refuse(raw, path, "a list of texts is needed",
           list.variables.empty() ? "write for example [\"h\", \"q\"]"
                                  : "write for example [\"q\", \"q^2/h + h^2/2\"]");
  std::vector<std::string> texts;
  for (const raw_value& item : *items) {
    const auto* text = std::get_if<std::string>(&item.value);
    if (text == nullptr) refuse(item, path, "a list of texts is needed", type_advice(key_type::text));
    texts.push_back(*text);
    if (list.variables.empty()) continue;
    source_place place = item.value_place;
    if (place.column > 0) ++place.column;  // after the quotation mark
    const expression formula(*text, place, formula_kind{variables, false, constants});
  }
  if (list.variables.empty()) check_names(raw, path, texts, constants);
  return texts;
}

case_value to_value(const case_key& key, const raw_value& raw, const case_config& so_far) {
  switch (key.type) {
    case key_type::integer:
      return integer(key, raw);
    case key_type::number:
      return number(key, raw, key.path);
    case key_type::text:
      if (!std::holds_alternative<std::string>(raw.value))
        refuse(
            raw, key.path, type_text(key.type) + " is needed",
            advice_for_text(raw, key.path, key.choices ? key.choices(so_far) : std::vector<std::string>{}));
      check_choice(key, raw, so_far);
      return std::get<std::string>(raw.value);
    case key_type::quantity:
      return positive_quantity(key, raw);
    case key_type::formula:
      return formula(key, raw);
    case key_type::text_list:
      return texts(key, raw);
    case key_type::formulas:
      return formula_texts(raw, key.path);
    case key_type::integers:
      return integers(key, raw);
    case key_type::intervals:
      return intervals(key, raw);
    case key_type::points:
      return points(key, raw);
  }
  return {};
}

std::vector<std::string> formula_texts(const raw_value& raw, const std::string& path) {
  const auto* list = std::get_if<raw_value::list>(&raw.value);
  if (list == nullptr || list->empty()) return {formula_text(raw, path)};
  std::vector<std::string> formulas;
  for (const auto& component : *list) formulas.push_back(formula_text(component, path));
  return formulas;
}

std::vector<double> constant_numbers(const raw_value& raw, const std::string& path,
                                     const formula_constants& constants) {
  std::vector<double> numbers;
  for (const auto& text : formula_texts(raw, path)) {
    const expression value(text, raw.value_place, formula_of_position(0, false, constants));
    if (!value.is_constant()) refuse(raw, path, "it depends on x", "give numbers");
    numbers.push_back(value.evaluate(position{}));
  }
  return numbers;
}

}  // namespace apsis
