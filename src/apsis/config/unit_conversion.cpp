// Values with units become dimensionless before any formula is read.
#include <apsis/body/shape_registry.hpp>
#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/config/case_value.hpp>
#include <apsis/config/gas_reader.hpp>
#include <apsis/config/profile_reader.hpp>
#include <apsis/config/quantity.hpp>
#include <apsis/config/table_reader.hpp>

#include <map>

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

void remove_units(case_text& text, const model_entry& model, const std::optional<gas_scales>& scales) {
  read_profiles(text, scales);
  const unit_remover remover(model, scales, text);
  read_tables_in_time(text, [&](const std::string& path) { return remover.dimension_of(path); }, scales);
  for (auto& [path, raw] : text.values) remover.convert(path, raw);
}

}  // namespace apsis
