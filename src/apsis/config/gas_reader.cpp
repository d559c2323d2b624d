#include <apsis/config/gas_reader.hpp>

#include <apsis/config/case_schema.hpp>
#include <apsis/config/case_value.hpp>
#include <apsis/config/quantity.hpp>
#include <apsis/model/expression.hpp>
#include <apsis/model/mean_free_path.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

/// Relative difference up to which two numbers of a case are the same.
constexpr double rounding = 1e-9;

const raw_value* find(const case_text& text, const std::string& path) {
  const auto found = text.values.find(path);
  return found == text.values.end() ? nullptr : &found->second;
}

bool is_text(const raw_value& raw, const char* expected) {
  const auto* text = std::get_if<std::string>(&raw.value);
  return text != nullptr && *text == expected;
}

/// Returns the place of a table; the first line if its keys are overrides.
source_place place_of_table(const case_text& text, const case_config& config, const std::string& table) {
  const auto found = text.tables.find(table);
  return found == text.tables.end() ? source_place{config.source, 1, 1} : found->second;
}

/// Returns the gas of a table [gas], from its name and its own values.
gas_species make_gas(const case_text& text, const case_config& config, double temperature) {
  const auto& given = config.gas;
  gas_species gas = given.name ? *try_find_gas(*given.name) : gas_species{};
  const auto need = [&](bool known, const char* key, const char* example) {
    if (!known)
      throw input_error(place_of_table(text, config, "gas"),
                        fmt::format("key 'gas.{}' is missing (the gas has no name from which it is known); "
                                    "add name = \"argon\", or {} = {}",
                                    key, key, example));
  };
  need(given.name || given.mass, "mass", "\"6.63e-26 kg\"");
  need(given.name || given.viscosity, "viscosity", "\"2.1e-5 Pa s\"");
  need(given.name || given.viscosity_exponent, "viscosity_exponent", "0.81");
  const auto value = [](const std::string& quantity) { return parse_quantity(quantity, {}).value; };
  if (given.mass) gas.mass = value(*given.mass);
  if (given.viscosity) {
    gas.viscosity = value(*given.viscosity);
    gas.viscosity_temperature = temperature;
  }
  if (given.viscosity_temperature) gas.viscosity_temperature = value(*given.viscosity_temperature);
  if (given.viscosity_exponent) gas.viscosity_exponent = *given.viscosity_exponent;
  if (given.degrees_of_freedom) gas.degrees_of_freedom = *given.degrees_of_freedom;
  if (given.degrees_of_freedom || !given.name) gas.prandtl = eucken_prandtl(gas.degrees_of_freedom);
  if (given.prandtl) gas.prandtl = *given.prandtl;
  return gas;
}

/// Returns p = n k T from the one key that gives it.
double read_pressure(const case_text& text, const case_config& config, double mass, double temperature) {
  const auto& given = config.gas;
  const auto value = [](const std::string& quantity) { return parse_quantity(quantity, {}).value; };
  const double energy = gas_scales::boltzmann * temperature;
  std::vector<std::pair<std::string, double>> all;
  if (given.pressure) all.emplace_back("gas.pressure", value(*given.pressure));
  if (given.density) all.emplace_back("gas.density", value(*given.density) / mass * energy);
  if (given.number_density) all.emplace_back("gas.number_density", value(*given.number_density) * energy);
  if (all.empty())
    throw input_error(
        place_of_table(text, config, "gas"),
        "no reference density is given (one of pressure, density and number_density is needed); "
        "add for example pressure = \"10 Pa\"");
  if (all.size() > 1)
    throw input_error(
        find(text, all[1].first)->place,
        fmt::format("'{}' conflicts with '{}' (exactly one of pressure, density and number_density sets the "
                    "reference density); remove one of them",
                    all[1].first, all[0].first));
  return all.front().second;
}

double required(const case_text& text, const case_config& config, const std::optional<std::string>& value,
                const char* name, const char* example) {
  if (!value)
    throw input_error(
        place_of_table(text, config, "gas"),
        fmt::format("key 'gas.{}' is missing (the units of the case follow from it); add it, for "
                    "example: {} = \"{}\"",
                    name, name, example));
  return parse_quantity(*value, {}).value;
}

const model_parameter* find_parameter(const model_entry& model, const std::string& name) {
  for (const model_parameter& one : model.parameters)
    if (one.name == name) return &one;
  return nullptr;
}

/// Returns "3" or "3 to 5".
std::string range_of(const model_parameter& parameter) {
  return parameter.lowest == parameter.highest
             ? fmt::format("{:g}", parameter.lowest)
             : fmt::format("{:g} to {:g}", parameter.lowest, parameter.highest);
}

/// Returns a suggestion with the models that take the value of a gas.
std::string suggest_models(const std::string& key, double number) {
  std::vector<std::string> names;
  for (const model_entry* one : model_entries()) {
    const model_parameter* parameter = find_parameter(*one, key);
    if (parameter != nullptr && number >= parameter->lowest && number <= parameter->highest)
      names.push_back(fmt::format("\"{}\"", one->name));
  }
  return names.empty() ? "choose another gas"
                       : fmt::format("choose model.name = {}, or another gas", fmt::join(names, " or "));
}

}  // namespace

std::optional<gas_scales> read_gas_scales(const case_text& text, const model_entry& model,
                                          const case_config& config) {
  const bool given = text.tables.contains("gas") ||
                     std::any_of(text.values.begin(), text.values.end(),
                                 [](const auto& item) { return item.first.rfind("gas.", 0) == 0; });
  if (!given) return std::nullopt;
  if (!model.has_velocity_grid)
    throw input_error(
        place_of_table(text, config, "gas"),
        fmt::format("the table [gas] is not used (model '{}' is not a gas); remove it", model.name));
  const double temperature = required(text, config, config.gas.temperature, "temperature", "300 K");
  const double length = required(text, config, config.gas.length, "length", "1 mm");
  gas_species gas = make_gas(text, config, temperature);
  const double pressure = read_pressure(text, config, gas.mass, temperature);
  gas_scales scales(std::move(gas), pressure, temperature, length);
  for (const auto& one : scales.quantities())
    if (!std::isnormal(one.value) && one.name != "viscosity_exponent")
      throw input_error(
          place_of_table(text, config, "gas"),
          fmt::format(
              "the table [gas] gives {} = {:g} (beyond the range of double precision); change its values",
              one.name, one.value));
  return scales;
}

void set_gas_of_model(case_text& text, const model_entry& model, const case_config& config) {
  const gas_scales& scales = *config.scales;
  const source_place table = place_of_table(text, config, "gas");
  const gas_species& gas = scales.gas();
  const auto set = [&](const std::string& name, auto value, const std::string& shown_value) {
    raw_value implied;
    implied.value = value;
    implied.what = fmt::format("{}, that of the table [gas]", shown_value);
    implied.place = implied.value_place = table;
    text.values.emplace("model." + name, std::move(implied));
  };
  for (const model_option& option : model.options) {
    if (option.name != "collision_rate") continue;
    const raw_value* raw = find(text, "model.collision_rate");
    if (raw != nullptr && !is_text(*raw, "viscosity"))
      refuse(*raw, "model.collision_rate", "a table [gas] gives the viscosity of the model",
             "write collision_rate = \"viscosity\", or remove the key");
    set("collision_rate", std::string("viscosity"), "\"viscosity\"");
  }
  for (const auto& [name, value] :
       {std::pair<const char*, double>{"viscosity_exponent", gas.viscosity_exponent},
        {"prandtl", gas.prandtl},
        {"degrees_of_freedom", static_cast<double>(gas.degrees_of_freedom)}}) {
    const std::string key = name;
    const double number = value;
    const model_parameter* known = find_parameter(model, key);
    if (known == nullptr) continue;
    if (number < known->lowest || number > known->highest)
      throw input_error(table,
                        fmt::format("the table [gas] has {} = {:g} (model '{}' takes {}); {}", key, number,
                                    model.name, range_of(*known), suggest_models(key, number)));
    if (const raw_value* raw = find(text, "model." + key)) {
      const double own = finite_number(*raw, "model." + key, type_text(key_type::number));
      if (!(std::abs(own - number) <= rounding * std::abs(number)))
        refuse(*raw, "model." + key, fmt::format("the table [gas] has {:g}", number),
               "remove it, or change [gas]");
    }
    text.values.erase("model." + key);
    set(key, number, fmt::format("{:g}", number));
  }
}

namespace {

/// Derives model.epsilon from the other keys that may give it.
class epsilon_reader {
 public:
  epsilon_reader(case_text& text, const model_entry& model, const case_config& config)
      : text_(text), model_(model), config_(config) {}

  std::optional<epsilon_formula> derive() {
    check_conflicts();
    const bool table = text_.tables.contains("model.knudsen");
    if (table || find(text_, "model.knudsen.value") || find(text_, "model.knudsen.mean_free_path"))
      take_knudsen();
    else if (const raw_value* raw = find(text_, "model.rarefaction"))
      take_rarefaction(*raw);
    else if (const raw_value* name = find(text_, "model.knudsen"))
      check_from_gas(*name);
    if (config_.scales) agree_with_gas(*config_.scales);
    return formula_;
  }

 private:
  void check_conflicts() const {
    std::string first;
    for (const char* key : {"model.epsilon", "model.knudsen", "model.knudsen.value",
                            "model.knudsen.mean_free_path", "model.rarefaction"}) {
      const raw_value* raw = find(text_, key);
      if (raw == nullptr) continue;
      const std::string name = std::string(key).rfind("model.knudsen.", 0) == 0 ? "model.knudsen table" : key;
      if (!first.empty() && first != name)
        throw input_error(raw->place, fmt::format("'{}' conflicts with '{}' (each sets the Knudsen number); "
                                                  "remove one of them",
                                                  key, first));
      first = name;
    }
  }

  const case_key& key(const std::string& path) const {
    const auto& schema = case_schema();
    return *std::find_if(schema.begin(), schema.end(), [&path](const case_key& k) { return k.path == path; });
  }

  void take_knudsen() {
    const raw_value* value = find(text_, "model.knudsen.value");
    const raw_value* definition = find(text_, "model.knudsen.mean_free_path");
    if (value == nullptr || definition == nullptr)
      throw input_error(
          value != nullptr ? value->place : place_of_table(text_, config_, "model.knudsen"),
          fmt::format("key 'model.knudsen.{}' is missing (definitions of the mean free path differ by more "
                      "than a half); write for example knudsen = {{value = 0.1, mean_free_path = \"vhs\"}}",
                      value == nullptr ? "value" : "mean_free_path"));
    const auto name =
        std::get<std::string>(to_value(key("model.knudsen.mean_free_path"), *definition, config_));
    const double factor = 1.0 / try_find_mean_free_path(name)->knudsen_of_epsilon(viscosity_exponent());
    set(*value, {.key = "model.knudsen.value", .mean_free_path = name, .conversion = {factor, false}});
  }

  void take_rarefaction(const raw_value& raw) {
    set(raw, {.key = "model.rarefaction", .conversion = {std::numbers::sqrt2, true}});
  }

  /// Sets ε to the converted number, or to the formula; derive() returns its conversion.
  void set(const raw_value& raw, epsilon_formula of) {
    check_rate(raw, of.key);
    of.text = std::get<std::string>(to_value(key(of.key), raw, config_));
    source_place place = raw.value_place;
    if (place.column > 0 && std::holds_alternative<std::string>(raw.value)) ++place.column;
    const int dimensions = prototype(model_).space_dimensions();
    const expression own(of.text, place, formula_of_position(dimensions, true, config_.constants));
    raw_value epsilon = raw;
    if (own.is_constant()) {
      const double value = of.conversion(own.evaluate(position{}));
      if (!std::isfinite(value))
        refuse(raw, of.key, "epsilon is not finite", "change it to a value in the range of positive numbers");
      epsilon.value = value;
    } else {
      epsilon.value = of.text;
      formula_ = std::move(of);
    }
    text_.values.insert_or_assign("model.epsilon", std::move(epsilon));
  }

  void check_rate(const raw_value& raw, const std::string& path) const {
    const raw_value* rate = find(text_, "model.collision_rate");
    if (rate != nullptr && is_text(*rate, "viscosity")) return;
    refuse(raw, path,
           "a mean free path follows from the viscosity epsilon T^s, which the model has only with "
           "collision_rate = \"viscosity\"",
           "add collision_rate = \"viscosity\" to [model], or give epsilon");
  }

  /// Returns the viscosity exponent of the model. For a value out of range, which is refused later, it
  /// returns the default.
  double viscosity_exponent() const {
    const auto& all = model_.parameters;
    const auto known = std::find_if(all.begin(), all.end(),
                                    [](const model_parameter& p) { return p.name == "viscosity_exponent"; });
    const raw_value* raw = find(text_, "model.viscosity_exponent");
    if (raw == nullptr) return known->value;
    const double given = finite_number(*raw, "model.viscosity_exponent", type_text(key_type::number));
    return given >= known->lowest && given <= known->highest ? given : known->value;
  }

  void check_from_gas(const raw_value& raw) const {
    if (!is_text(raw, "from gas"))
      refuse(raw, "model.knudsen", "a Knudsen number needs the definition of its mean free path",
             "write for example knudsen = {value = 0.1, mean_free_path = \"vhs\"}");
    if (!config_.scales)
      refuse(raw, "model.knudsen", "there is no table [gas]",
             "add it, or write for example knudsen = {value = 0.1, mean_free_path = \"vhs\"}");
  }

  void agree_with_gas(const gas_scales& scales) {
    const double epsilon = scales.epsilon();
    const raw_value* raw = find(text_, "model.epsilon");
    if (raw == nullptr) {
      raw_value implied;
      implied.value = epsilon;
      implied.what = fmt::format("{:g}, that of the table [gas]", epsilon);
      implied.place = implied.value_place = place_of_table(text_, config_, "gas");
      text_.values.emplace("model.epsilon", std::move(implied));
      return;
    }
    const std::string given = std::get<std::string>(to_value(key("model.epsilon"), *raw, config_));
    const int dimensions = prototype(model_).space_dimensions();
    const expression formula(given, raw->value_place,
                             formula_of_position(dimensions, true, config_.constants));
    const position origin{};
    if (!formula.is_constant() || !(std::abs(formula.value(origin) - epsilon) <= rounding * epsilon))
      throw input_error(raw->place,
                        fmt::format("the Knudsen number contradicts the table [gas] (epsilon is {:g} "
                                    "there, {} here); remove it, or change [gas]",
                                    epsilon, shown(given)));
  }

  case_text& text_;
  const model_entry& model_;
  const case_config& config_;
  std::optional<epsilon_formula> formula_;  ///< formula of a key other than model.epsilon
};

}  // namespace

std::optional<epsilon_formula> derive_epsilon(case_text& text, const model_entry& model,
                                              const case_config& config) {
  return epsilon_reader(text, model, config).derive();
}

}  // namespace apsis
