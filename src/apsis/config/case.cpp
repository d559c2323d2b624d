#include <apsis/config/case.hpp>

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/config/body_reader.hpp>
#include <apsis/config/case_resolver.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/config/case_text.hpp>
#include <apsis/config/case_value.hpp>
#include <apsis/config/quantity.hpp>
#include <apsis/config/solid_reader.hpp>
#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Returns whether some model has a list with this path. Its name may be that of an option of another model.
bool is_list(const std::string& path) {
  for (const model_entry* entry : model_entries())
    for (const model_list& list : entry->lists)
      if ("model." + list.name == path) return true;
  return false;
}

/// Returns whether the key is in a table [[output.probe]], [[output.slice]] or [output.reference].
bool is_output_table(const std::string& path) {
  return path.rfind("output.probe.", 0) == 0 || path.rfind("output.slice.", 0) == 0 ||
         path.rfind("output.reference.", 0) == 0;
}

/// Returns the syntax of a key on the command line. Unknown keys need no quotes, so that the
/// message is about the key.
override_form form_of(const std::string& path, const std::string& value) {
  if (looks_like_quantity(value)) return {true, type_advice(key_type::quantity)};
  for (const case_key& key : case_schema())
    if (key.path == path && (key.type == key_type::formulas || key.type == key_type::text_list))
      return {value.find('[') != 0, type_advice(key.type)};
  for (const case_key& key : case_schema())
    if (key.path == path)
      return {key.type == key_type::text || key.type == key_type::formula || key.type == key_type::quantity,
              type_advice(key.type)};
  if (path.rfind("parameters.", 0) == 0) return {false, type_advice(key_type::number)};
  // Names of numeric parameters and string options are disjoint over all models.
  for (const model_entry* entry : model_entries())
    for (const model_parameter& p : entry->parameters)
      if ("model." + p.name == path)
        return {p.automatic && value == automatic_word,
                type_advice(p.integer ? key_type::integer : key_type::number)};
  if (is_output_table(path))
    return {path.ends_with(".name") || path.ends_with(".normal"), "write for example 0.5 or [0.5, 0.2]"};
  const bool list = is_list(path);
  const bool may_be_list = list || path.rfind("initial.", 0) == 0 || path.rfind("boundary.", 0) == 0 ||
                           path.rfind("space.solid.", 0) == 0 || path.rfind("space.body.", 0) == 0;
  const bool bracket = may_be_list && value.find('[') == 0;
  return {!bracket, type_advice(list && bracket ? key_type::text_list : key_type::text)};
}

/// Returns the text without surrounding spaces, which quoted arguments such as "space.cells = 80" have.
std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// Groups of keys that exclude each other.
const std::vector<std::vector<std::vector<std::string>>>& exclusive_keys() {
  static const std::vector<std::vector<std::vector<std::string>>> all = {
      {{"time.dt"}, {"time.cfl"}, {"time.safety"}},
      {{"space.boundary"}, {"boundary.all.kind"}},
      {{"gas.pressure"}, {"gas.density"}, {"gas.number_density"}},
      {{"model.epsilon"},
       {"model.knudsen"},
       {"model.knudsen.value", "model.knudsen.mean_free_path"},
       {"model.rarefaction"}}};
  return all;
}

/// Erases all initial data: those from a file, or from the caller, replace them.
void erase_initial_data(case_text& text) {
  const auto in_table = [](const auto& entry) {
    return entry.first == "initial" || entry.first.rfind("initial.", 0) == 0;
  };
  std::erase_if(text.values, in_table);
  std::erase_if(text.tables, in_table);
  text.values.erase("model.initial");
}

/// Erases the keys of the file that a key on the command line replaces, because they exclude each other.
void erase_alternatives(case_text& text, const std::string& path) {
  const bool file = path == "initial.file" && !text.values.contains(path);
  if (file || path == "initial.from") erase_initial_data(text);
  for (const auto& groups : exclusive_keys()) {
    const auto contains = [&path](const std::vector<std::string>& group) {
      return std::find(group.begin(), group.end(), path) != group.end();
    };
    if (std::none_of(groups.begin(), groups.end(), contains)) continue;
    for (const auto& group : groups)
      if (!contains(group))
        for (const auto& key : group) text.values.erase(key);
    if (path.rfind("model.", 0) == 0 && path.rfind("model.knudsen.", 0) != 0)
      text.tables.erase("model.knudsen");
  }
}

bool is_open_list(const std::string& text) {
  return std::count(text.begin(), text.end(), '[') > std::count(text.begin(), text.end(), ']');
}

/// Returns the override that begins with a word and that the shell split at spaces.
std::string joined_override(const std::vector<std::string>& words, std::size_t first) {
  std::string whole = words[first];
  for (std::size_t k = first + 1; k < words.size(); ++k) {
    const bool around_equals = whole.ends_with('=') || words[k].starts_with('=');
    if (!around_equals && !is_open_list(whole)) break;
    whole += (around_equals ? "" : " ") + words[k];
  }
  return whole;
}

/// Refuses a word that is not of the form key=value. Its neighbours may be parts of the same override.
[[noreturn]] void refuse_form(const std::vector<std::string>& words, std::size_t at,
                              const source_place& place) {
  const bool ends_another = at > 0 && (words[at - 1].ends_with('=') || is_open_list(words[at - 1]));
  const std::size_t first = ends_another ? at - 1 : at;
  const std::string whole = joined_override(words, first);
  if (whole == words[first])
    throw input_error(
        place, "not of the form key=value (an override sets one key); write for example space.cells=80");
  const bool has_space = whole.find(' ') != std::string::npos;
  throw input_error(place, fmt::format("not of the form key=value (the shell splits it at spaces); {}",
                                       has_space ? fmt::format("quote all of it: '{}'", shown(whole))
                                                 : fmt::format("write {} without spaces", shown(whole))));
}

void apply_overrides(case_text& text, const std::vector<std::string>& overrides) {
  struct key_and_value {
    std::string path, value;
    source_place place;
  };
  std::vector<key_and_value> all;
  for (std::size_t k = 0; k < overrides.size(); ++k) {
    const std::string& item = overrides[k];
    const source_place place{fmt::format("override '{}'", shown(item)), 0, 0};
    const auto equals = item.find('=');
    const std::string path = trimmed(item.substr(0, equals));
    if (equals == std::string::npos || path.empty()) refuse_form(overrides, k, place);
    all.push_back({path, trimmed(item.substr(equals + 1)), place});
  }
  for (const auto& item : all) erase_alternatives(text, item.path);
  for (const auto& [path, value, place] : all) apply_override(text, path, value, form_of(path, value), place);
}

}  // namespace

case_config parse_case(std::string_view text, const std::string& file,
                       const std::vector<std::string>& overrides) {
  case_text flat = read_case_text(text, file);
  apply_overrides(flat, overrides);
  return resolve_case(std::move(flat), file);
}

case_config load_case(const std::string& name_or_path, const std::vector<std::string>& overrides) {
  return parse_case(read_case(name_or_path), name_or_path, overrides);
}

velocity_config velocities_of(const case_config& config) {
  const auto& given = config.velocity;
  velocity_config all = {given.max, given.points, given.equilibrium, given.set};
  if (config.is_axisymmetric()) {
    all.rings = given.rings;
    all.angles = given.angles;
    all.max_across = given.max_across.value_or(0.0);
  }
  return all;
}

std::shared_ptr<const model> make_model(const case_config& config) {
  const model_entry& entry = find_model(config.model.name);
  model_config parts = default_config(entry);
  for (const auto& [name, value] : config.model.parameters) parts.parameters[name] = value;
  for (const auto& [name, value] : config.model.options) parts.options[name] = value;
  for (const auto& [name, value] : config.model.lists) parts.lists[name] = value;
  parts.constants = config.constants;
  parts.space_dimensions = static_cast<int>(config.space.cells.size());
  parts.velocity = velocities_of(config);
  const auto make = [&]() -> std::shared_ptr<const model> { return entry.make(parts); };
  return config.parts->equation.get({&entry, parts}, make);
}

source_place place_of(const case_config& config, const std::string& path) {
  for (std::string known = path; !known.empty();) {
    const auto found = config.places.find(known);
    if (found != config.places.end()) return found->second;
    const auto dot = known.rfind('.');
    known.resize(dot == std::string::npos ? 0 : dot);
  }
  return {};
}

expression make_epsilon(const case_config& config, int dimensions) {
  const epsilon_formula& given = config.model.epsilon;
  return expression(given.text, place_of(config, "model.epsilon"),
                    formula_of_position(dimensions, true, config.constants))
      .converted(given.conversion);
}

grid make_mesh(const case_config& config) {
  std::array<int, 3> cells = {1, 1, 1};
  std::array<double, 3> lower{}, upper = {1.0, 1.0, 1.0};
  for (std::size_t k = 0; k < config.space.cells.size() && k < 3; ++k) {
    cells[k] = config.space.cells[k];
    lower[k] = config.space.domain.at(k)[0];
    upper[k] = config.space.domain.at(k)[1];
  }
  const grid plain(static_cast<int>(config.space.cells.size()), cells, lower, upper);
  const grid mesh = config.is_axisymmetric() ? plain.about_axis() : plain;
  const grid with_boxes = config.solids.empty() ? mesh : mesh.with_solids(solid_boxes(config, mesh));
  return config.bodies.empty() ? with_boxes : with_boxes.with_cut_cells(cut_cells_of(config, with_boxes));
}

}  // namespace apsis
