#include <apsis/config/boundary_reader.hpp>

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/config/at_place.hpp>
#include <apsis/config/case_value.hpp>
#include <apsis/config/common_boundary.hpp>
#include <apsis/config/space_time_formula.hpp>
#include <apsis/config/suggest_variable.hpp>
#include <apsis/core/suggest.hpp>

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

const std::string& kind_of(const case_config& config, const face_table& table) {
  return table.kind ? *table.kind : config.space.boundary;
}

/// Returns the names of the variables of a kind of boundary.
std::vector<std::string> variables_of(const std::string& kind, const model& equation) {
  std::vector<std::string> names;
  const boundary_entry& entry = find_boundary(kind);
  if (entry.variables == nullptr) return names;
  for (const auto& variable : entry.variables(equation)) names.push_back(variable.name);
  return names;
}

/// Returns a formula in t and the position, for functions of the velocity also in the velocity. Returns a
/// number if the formula is constant.
face_quantity compile(const std::string& text, const source_place& place, const case_config& config,
                      const model& equation, const std::optional<data_variable>& variable) {
  const int velocity = variable && variable->of_velocity ? equation.velocities().dimensions() : 0;
  const space_time_formula formula(text, place, config.constants, equation.space_dimensions(), velocity);
  if (formula.is_constant()) return formula.at(0.0, {});
  if (variable && variable->over_surface && !formula.is_uniform())
    throw input_error(place,
                      fmt::format("'{}' depends on the position (it belongs to the whole surface); give "
                                  "a number or a formula in t",
                                  variable->name));
  return face_quantity(
      [formula](double t, const position& x, const position& v) { return formula.at(t, x, v); });
}

}  // namespace

std::vector<std::string> boundary_variables(const std::string& kind, const model& equation,
                                            const source_place& place) {
  return at_place(place, [&] { return variables_of(kind, equation); });
}

source_place place_of_emitter(const case_config& config, const std::string& path) {
  if (path.starts_with("boundary.") && !config.places.contains(path))
    for (const char* all : {"boundary.all", "boundary.all.kind"})
      if (config.places.contains(all)) return place_of(config, all);
  source_place table = place_of(config, path);
  if (!table.file.empty()) return table;
  if (config.places.contains(path + ".kind")) return place_of(config, path + ".kind");
  const auto key = config.places.lower_bound(path + ".");
  if (key != config.places.end() && key->first.starts_with(path + ".")) return key->second;
  return place_of(config, "space.boundary");
}

namespace {

/// Returns the name of a surface in messages, by the path of its table.
std::string surface_name(const case_config& config, const std::string& path) {
  for (std::size_t k = 0; k < config.solids.size(); ++k)
    if (path == fmt::format("space.solid.{}", k + 1))
      return fmt::format("solid box '{}'", config.solids[k].name);
  for (std::size_t k = 0; k < config.bodies.size(); ++k)
    if (path == fmt::format("space.body.{}", k + 1)) return fmt::format("body '{}'", config.bodies[k].name);
  return fmt::format("[{}]", path);
}

}  // namespace

std::shared_ptr<const boundary> make_wall(const case_config& config, const model& equation,
                                          const std::string& path, const std::string& kind,
                                          const state_formulas& values) {
  const std::string surface = surface_name(config, path);
  face_quantities compiled;
  for (const auto& [name, formulas] : values)
    for (const auto& formula : formulas) {
      const source_place at = place_of(config, fmt::format("{}.{}", path, name));
      compiled[name].push_back(compile(formula, at, config, equation, variable_of(kind, equation, name)));
      compiled[name].back().set_origin({at, surface, equation.space_dimensions()});
    }
  return at_place(place_of_emitter(config, path),
                  [&] { return make_boundary(kind, equation, compiled, surface); });
}

namespace {

/// Refuses a key of a table that is no face, or a face that is no table.
[[noreturn]] void refuse_face(const raw_value& raw, const std::string& path, const std::string& name) {
  std::vector<std::string> names(face_names.begin(), face_names.end());
  names.emplace_back(every_face);
  const bool known = std::find(names.begin(), names.end(), name) != names.end();
  const bool of_all = path == "boundary." + name && nearest_word(name, names).empty();
  throw input_error(
      raw.place, fmt::format("unknown key '{}' (a face is a table [boundary.left], [boundary.right], …); {}",
                             shown(path),
                             known    ? fmt::format("write [boundary.{}]", name)
                             : of_all ? "write [boundary.all] for keys of all faces"
                                      : suggest(name, names)));
}

}  // namespace

void read_boundary_values(const case_text& text, const model& equation, case_config& config) {
  const std::string head = "boundary.";
  for (const auto& [path, raw] : text.values) {
    if (path.rfind(head, 0) != 0) continue;
    const auto dot = path.find('.', head.size());
    const std::string side = path.substr(head.size(), dot == std::string::npos ? dot : dot - head.size());
    const std::string name = dot == std::string::npos ? "" : path.substr(dot + 1);
    const auto found = std::find(face_names.begin(), face_names.end(), side);
    const bool known = found != face_names.end();
    if (side == every_face && name == "kind") continue;
    if (name.empty() || !known) refuse_face(raw, path, side);
    const auto index = static_cast<std::size_t>(found - face_names.begin());
    if (face_of(index).direction >= equation.space_dimensions())
      throw input_error(
          raw.place,
          fmt::format("key '{}' is not used (the case has {} space dimension{}); remove it", shown(path),
                      equation.space_dimensions(), equation.space_dimensions() == 1 ? "" : "s"));
    if (name == "kind") continue;
    face_table& table = config.faces[index];
    const std::string& kind = kind_of(config, table);
    auto names = boundary_variables(kind, equation, raw.place);
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      names.emplace_back("kind");
      const std::string given = given_boundary_path(config, path);
      throw input_error(raw.place, fmt::format("unknown key '{}' (boundary '{}' has no such variable); {}",
                                               shown(given), kind, suggest_variable(name, names)));
    }
    table.values[name] = formula_texts(raw, given_boundary_path(config, path));
  }
}

std::vector<domain::faces> make_boundaries(const case_config& config,
                                           const std::shared_ptr<const model>& equation) {
  const auto made = [&](std::size_t k) {
    const face_table& table = config.faces[k];
    return make_wall(config, *equation, "boundary." + face_names[k], kind_of(config, table), table.values);
  };
  const auto make = [&] {
    std::vector<domain::faces> sides;
    for (std::size_t k = 0; k < 2 * config.space.cells.size(); k += 2)
      sides.push_back({made(k), made(k + 1)});
    return sides;
  };
  return config.parts->sides.get({equation, config.space.boundary, config.faces, config.constants}, make);
}

}  // namespace apsis
