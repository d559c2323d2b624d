// Values with units become dimensionless before any formula is read.
#include <apsis/body/shape_registry.hpp>
#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/config/case_value.hpp>
#include <apsis/config/common_boundary.hpp>
#include <apsis/config/gas_reader.hpp>
#include <apsis/config/profile_reader.hpp>
#include <apsis/config/quantity.hpp>
#include <apsis/config/table_reader.hpp>

#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis {
namespace {

bool begins_with(const std::string& path, const char* head) {
  return path.rfind(head, 0) == 0;
}

/// Returns the dimension of areas of the case: none on a line, a length in the plane. About an axis, areas
/// are those of rings.
dimension dimension_of_area(const case_text& text) {
  const raw_value *cells = text.find("space.cells"), *geometry = text.find("space.geometry");
  const auto* list = cells == nullptr ? nullptr : std::get_if<raw_value::list>(&cells->value);
  const auto* name = geometry == nullptr ? nullptr : std::get_if<std::string>(&geometry->value);
  const std::size_t dimensions = list == nullptr ? 1 : list->size();
  const bool about_axis = name != nullptr && *name == choice_name(geometry_choice::axisymmetric);
  dimension area = dimensions::none;
  for (std::size_t k = 1; k < dimensions + (about_axis ? 1 : 0); ++k) area = area * dimensions::length;
  return area;
}

/// Returns the dimensions of the variables of [initial] and of boundaries by name.
std::map<std::string, dimension> measures_of_variables(const model& equation, const dimension& area) {
  std::map<std::string, dimension> dims;
  const auto add = [&](const std::vector<data_variable>& variables) {
    for (const auto& one : variables)
      dims[one.name] = one.over_surface ? one.dimension * area : one.dimension;
  };
  for (const auto& form : equation.data_forms()) add(form.variables);
  for (const boundary_entry* kind : boundary_entries()) {
    if (kind->variables == nullptr) continue;
    try {
      add(kind->variables(equation));
    } catch (const input_error&) {
      continue;  // the model cannot have this kind
    }
  }
  return dims;
}

/// Returns the dimensions of the parameters that have a unit, by name.
std::map<std::string, dimension> dimensions_of_parameters(const case_text& text) {
  const std::string head = "parameters.";
  std::map<std::string, dimension> dims;
  for (const auto& [path, raw] : text.values) {
    const auto* value = std::get_if<std::string>(&raw.value);
    if (begins_with(path, head.c_str()) && value != nullptr && looks_like_quantity(*value))
      dims[path.substr(head.size())] = parse_quantity(*value, raw.place).unit;
  }
  return dims;
}

class unit_remover {
 public:
  unit_remover(const model_entry& model, const std::optional<gas_scales>& scales, const case_text& text)
      : model_(model),
        scales_(scales),
        variables_(measures_of_variables(prototype(model), dimension_of_area(text))),
        parameters_(dimensions_of_parameters(text)) {}

  void convert(const std::string& path, raw_value& raw) const {
    if (begins_with(path, "parameters.")) return convert(path, raw, nullptr);
    if (const auto dims = dimension_of(path)) convert(path, raw, &*dims);
  }

  /// Returns the dimension of a numeric key; nothing for a key that takes text.
  std::optional<dimension> dimension_of(const std::string& path) const {
    for (const case_key& key : case_schema())
      if (key.path == path) {
        const bool is_text =
            key.type == key_type::text || key.type == key_type::text_list || key.type == key_type::quantity;
        return is_text ? std::nullopt : std::optional(key.dimension);
      }
    for (const model_parameter& p : model_.parameters)
      if ("model." + p.name == path) return dimensions::none;
    if (begins_with(path, "output.probe.") || begins_with(path, "output.slice."))
      return path.ends_with(".from") || path.ends_with(".to") || path.ends_with(".at")
                 ? std::optional(dimensions::length)
                 : std::nullopt;
    for (const reference_key& key : reference_keys())
      if (path == std::string("output.reference.") + key.name) return key.dimension;
    if (path == "initial.time" && !variables_.contains("time")) return dimensions::time;
    const bool solid = begins_with(path, "space.solid.");
    if (solid && (path.ends_with(".from") || path.ends_with(".to"))) return dimensions::length;
    const bool body = begins_with(path, "space.body.");
    if (!begins_with(path, "initial.") && !begins_with(path, "boundary.") && !solid && !body)
      return std::nullopt;
    const std::string name = path.substr(path.rfind('.') + 1);
    if (body)
      if (const auto found = dimension_of_shape_key(name)) return found;
    const auto variable = variables_.find(name);
    return variable == variables_.end() ? std::nullopt : std::optional(variable->second);
  }

 private:
  /// Returns the dimension of the numbers of a key of a shape; nothing for other keys.
  static std::optional<dimension> dimension_of_shape_key(const std::string& name) {
    for (const shape_entry* shape : shape_entries())
      for (const auto& keys : {shape->keys, common_shape_keys(3)})
        for (const shape_key& key : keys)
          if (key.name == name && key.kind != shape_value_kind::text)
            return key.is_length ? dimensions::length : dimensions::none;
    return std::nullopt;
  }

  /// Converts a value. `dims` is the dimension of the key; null if any is valid.
  void convert(const std::string& path, raw_value& raw, const dimension* dims) const {
    if (auto* list = std::get_if<raw_value::list>(&raw.value)) {
      for (raw_value& item : *list) convert(path, item, dims);
      return;
    }
    const auto* text = std::get_if<std::string>(&raw.value);
    if (text == nullptr) return;
    if (dims != nullptr) check_parameter(path, raw, *text, *dims);
    if (const std::string spaced = with_missing_space(*text); !spaced.empty())
      refuse(raw, path, "a space is missing between number and unit", fmt::format("write \"{}\"", spaced));
    if (!looks_like_quantity(*text)) return;
    quantity given = parse_quantity(*text, raw.place);
    if (!scales_)
      refuse(raw, path, "a unit needs the scales of a gas",
             "add a table [gas], or give a dimensionless number");
    if (dims != nullptr && *dims == dimensions::density && given.unit == dimensions::number_density)
      given = {given.value * scales_->gas().mass, dimensions::density};
    if (dims != nullptr && given.unit != *dims)
      refuse(raw, path, fmt::format("its unit is that of {}", unit_of(given.unit)), advice(*dims));
    raw.value = given.value / scales_->unit(given.unit);
  }

  /// Refuses a value that is a parameter with the unit of another dimension. Formulas are not checked: their
  /// operations may change the dimension.
  void check_parameter(const std::string& path, const raw_value& raw, const std::string& name,
                       const dimension& dims) const {
    const auto found = parameters_.find(name);
    if (found != parameters_.end() && found->second != dims)
      refuse(raw, path,
             fmt::format("the unit of the parameter '{}' is that of {}", name, unit_of(found->second)),
             advice(dims));
  }

  /// Returns the suggestion for a value whose unit has another dimension than its key.
  static std::string advice(const dimension& dims) {
    if (dims == dimensions::none) return "give a number without a unit";
    // No viscosity is converted here: its dimension is that of a mass flow in the plane.
    return fmt::format("give it in {}",
                       dims == dimensions::viscosity ? unit_of_amount(dims, 1) : unit_of(dims));
  }

  const model_entry& model_;
  const std::optional<gas_scales>& scales_;
  std::map<std::string, dimension> variables_, parameters_;
};

}  // namespace

namespace {

/// Returns the units in which a dimensionless number was probably meant; "" if the number is plausible.
///
/// A large number is suspicious if its value in SI units is closer to the reference, as a ratio, than
/// itself: |x| > √T₀, for example. Temperatures of 20 T₀ and velocities of Mach 15 are plausible in any
/// case, and so are ratios of pressures below 100. Small densities are plausible, because gases expand into
/// vacuum. They are suspicious only within a factor 2 of a small reference density in kg/m³.
std::string probable_unit(const std::string& name, const dimension& dims, double number,
                          const gas_scales& scales) {
  constexpr double largest_ratio = 20.0, largest_pressure = 100.0, small_density = 0.1;
  const double x = std::abs(number);
  const auto beyond = [x](double least, double reference) { return x >= least && x > std::sqrt(reference); };
  if (dims == dimensions::temperature && beyond(largest_ratio, scales.temperature())) return unit_of(dims);
  if (dims == dimensions::velocity && beyond(largest_ratio, scales.speed())) return unit_of(dims);
  if (name == "p" && dims == dimensions::pressure && beyond(largest_pressure, scales.pressure()))
    return unit_of(dims);
  if (dims != dimensions::density) return "";
  if (beyond(largest_ratio, scales.number_density())) return unit_of(dimensions::number_density);
  const double ratio = x / scales.density();
  return x <= small_density && ratio >= 0.5 && ratio <= 2.0 ? unit_of(dims) : "";
}

/// A number that a value of a case contains: itself, an item of a list, or a constant of [parameters].
struct plain_number {
  double value = 0.0;
  std::string path;  ///< of the key that has the number
};

/// Returns the numbers without units and without operations.
std::vector<plain_number> plain_numbers(const case_text& text, const std::string& path,
                                        const raw_value& raw) {
  if (const auto* number = std::get_if<double>(&raw.value)) return {{*number, path}};
  if (const auto* number = std::get_if<long>(&raw.value)) return {{static_cast<double>(*number), path}};
  std::vector<plain_number> all;
  if (const auto* list = std::get_if<raw_value::list>(&raw.value))
    for (const raw_value& item : *list)
      for (plain_number& one : plain_numbers(text, path, item)) all.push_back(std::move(one));
  const auto* word = std::get_if<std::string>(&raw.value);
  if (word == nullptr) return all;
  double number = 0.0;
  const char* const end = word->data() + word->size();
  const auto [stop, problem] = std::from_chars(word->data(), end, number);
  if (problem == std::errc() && stop == end) return {{number, path}};
  const std::string constant = "parameters." + *word;
  const raw_value* found = text.find(constant);
  const bool is_number = found != nullptr && (std::holds_alternative<double>(found->value) ||
                                              std::holds_alternative<long>(found->value));
  return is_number ? plain_numbers(text, constant, *found) : all;
}

bool describes_a_state(const std::string& path) {
  return begins_with(path, "initial.") || begins_with(path, "boundary.") ||
         begins_with(path, "space.solid.") || begins_with(path, "space.body.") ||
         begins_with(path, "output.reference.");
}

}  // namespace

std::vector<std::string> warnings_of_missing_units(const case_text& text, const model_entry& model,
                                                   const case_config& config) {
  if (!config.scales) return {};
  const unit_remover remover(model, config.scales, text);
  std::vector<std::string> warnings;
  std::set<std::string> seen;  // a key of all faces occurs once
  for (const auto& [path, raw] : text.values) {
    const auto dims = describes_a_state(path) ? remover.dimension_of(path) : std::nullopt;
    if (!dims) continue;
    for (const plain_number& one : plain_numbers(text, given_boundary_path(config, path), raw)) {
      const std::string unit =
          probable_unit(path.substr(path.rfind('.') + 1), *dims, one.value, *config.scales);
      if (unit.empty() || !seen.insert(one.path).second) continue;
      const raw_value* given = text.find(one.path);
      warnings.push_back(fmt::format(
          "{}'{}' = {:g} is {:g} {} (a number without a unit is a multiple of the reference of [gas]); "
          "write \"{:g} {}\" if these units are meant",
          to_string((given == nullptr ? raw : *given).place), one.path, one.value,
          one.value * config.scales->unit(*dims), unit_of(*dims), one.value, unit));
      break;
    }
  }
  return warnings;
}

void remove_units(case_text& text, const model_entry& model, const std::optional<gas_scales>& scales) {
  read_profiles(text, scales);
  const unit_remover remover(model, scales, text);
  read_tables_in_time(text, [&](const std::string& path) { return remover.dimension_of(path); }, scales);
  for (auto& [path, raw] : text.values) remover.convert(path, raw);
}

}  // namespace apsis
