#include <apsis/config/body_reader.hpp>

#include <apsis/body/shape_registry.hpp>
#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/config/at_place.hpp>
#include <apsis/config/boundary_reader.hpp>
#include <apsis/config/case_value.hpp>
#include <apsis/config/list_of_tables.hpp>
#include <apsis/config/suggest_variable.hpp>
#include <apsis/config/surface_names.hpp>
#include <apsis/core/index.hpp>
#include <apsis/mesh/hidden_body.hpp>
#include <apsis/model/expression.hpp>

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

const std::string head_of_bodies = "space.body.";

std::string path_of_body(std::size_t body) {
  return fmt::format("{}{}", head_of_bodies, body + 1);
}

std::vector<shape_key> keys_of(const shape_entry& entry, int dimensions) {
  std::vector<shape_key> keys = entry.keys;
  for (shape_key& one : common_shape_keys(dimensions)) keys.push_back(std::move(one));
  return keys;
}

class reader_of_bodies {
 public:
  reader_of_bodies(const case_text& text, const model& equation, case_config& config)
      : text_(text), equation_(equation), config_(config) {}

  void read() {
    config_.bodies.clear();
    std::size_t count = 0;
    for (const auto& [path, raw] : text_.values)
      if (path.rfind(head_of_bodies, 0) == 0) count = std::max(count, number_in(path, raw));
    if (count > 0 && dimensions() < 2)
      throw input_error(place_of_emitter(config_, path_of_body(0)),
                        "a body on a line (it needs two or three dimensions); use [[space.solid]]");
    for (std::size_t k = 0; k < count; ++k) read_body(k);
  }

 private:
  int dimensions() const { return static_cast<int>(config_.space.cells.size()); }

  /// Returns the number of a body in the path of a key, counted from 1.
  static std::size_t number_in(const std::string& path, const raw_value& raw) {
    if (const auto split = split_key(path, head_of_bodies)) return split->number;
    throw input_error(
        raw.place,
        fmt::format("unknown key '{}' (bodies are a list of tables); write [[space.body]]", shown(path)));
  }

  void read_body(std::size_t number) {
    const std::string path = path_of_body(number);
    body_table body;
    taken_.clear();
    body.name = text_at(path + ".name").value_or(fmt::format("body-{}", number + 1));
    body.kind = text_at(path + ".kind").value_or(body.kind);
    const source_place place_of_kind = place_of_emitter(config_, path + ".kind");
    const boundary_entry& kind =
        at_place(place_of_kind, [&]() -> decltype(auto) { return std::cref(find_boundary(body.kind)); });
    if (!kind.any_normal) throw input_error(place_of_kind, why_no_wall_of_bodies(body.kind, equation_));
    const auto variables = boundary_variables(body.kind, equation_, place_of_emitter(config_, path));
    for (const std::string& name : variables) {
      const std::string key = fmt::format("{}.{}", path, name);
      if (const raw_value* raw = text_.find(key)) {
        body.values[name] = formula_texts(*raw, key);
        taken_.insert(key);
      }
    }
    std::vector<std::string> of_wall = {"name", "kind"};
    of_wall.insert(of_wall.end(), variables.begin(), variables.end());
    body.shape = read_shape(path, dimensions(), of_wall);
    std::vector<std::string> earlier;
    for (const auto& solid : config_.solids) earlier.push_back(solid.name);
    for (const auto& other : config_.bodies) earlier.push_back(other.name);
    check_surface_name(config_, path, body.name, earlier);
    config_.bodies.push_back(std::move(body));
  }

  std::optional<std::string> text_at(const std::string& path) {
    const raw_value* raw = text_.find(path);
    if (raw == nullptr) return std::nullopt;
    const auto* text = std::get_if<std::string>(&raw->value);
    if (text == nullptr)
      refuse(*raw, path, "it must be a text", fmt::format("write for example {} = \"...\"", last_of(path)));
    taken_.insert(path);
    return *text;
  }

  static std::string last_of(const std::string& path) { return path.substr(path.rfind('.') + 1); }

  source_place place_of_shape(const std::string& path) const {
    if (const raw_value* raw = text_.find(path + ".shape")) return raw->place;
    const auto table = text_.tables.find(path);
    return table != text_.tables.end() ? table->second : place_of_emitter(config_, path);
  }

  /// Reads a shape and checks that it has all other keys of its table. `of_wall` has the keys of the wall of
  /// a body; shapes within a shape have none.
  shape_table read_shape(const std::string& path, int dimensions,
                         const std::vector<std::string>& of_wall = {}) {
    shape_table table;
    const auto kind = text_at(path + ".shape");
    if (!kind)
      throw input_error(place_of_shape(path),
                        fmt::format("key '{}.shape' is missing (a body has a shape); add for example "
                                    "shape = \"{}\"",
                                    path, dimensions == 2 ? "circle" : "sphere"));
    table.shape = *kind;
    const shape_entry& entry = at_place(
        place_of_shape(path), [&]() -> decltype(auto) { return std::cref(find_shape(table.shape)); });
    for (const shape_key& key : keys_of(entry, dimensions)) {
      const std::string of_key = path + "." + key.name;
      if (key.kind == shape_value_kind::shapes)
        read_parts(of_key, key, key.planar ? 2 : dimensions, table.parts[key.name]);
      else if (const raw_value* raw = text_.find(of_key))
        table.values[key.name] = value_of(*raw, of_key, key);
    }
    std::erase_if(table.parts, [](const auto& one) { return one.second.empty(); });
    check_all_taken(path, table, dimensions, of_wall);
    return table;
  }

  /// Reads shapes from a list of tables, or from a single table.
  void read_parts(const std::string& path, const shape_key& key, int dimensions,
                  std::vector<shape_table>& parts) {
    if (const raw_value* raw = text_.find(path))
      refuse(*raw, path,
             key.fewest > 1 ? fmt::format("it needs at least {} shapes", key.fewest) : "it needs a shape",
             fmt::format("write for example {} = [{{ shape = {}, radius = 1 }}{}]", key.name,
                         dimensions == 2 ? "\"circle\", centre = [0, 0]" : "\"sphere\", centre = [0, 0, 0]",
                         key.fewest > 1 ? ", …" : ""));
    const auto has = [&](const std::string& table) { return text_.tables.contains(table); };
    for (int k = 1; has(fmt::format("{}.{}", path, k)); ++k)
      parts.push_back(read_shape(fmt::format("{}.{}", path, k), dimensions));
    if (parts.empty() && has(path)) parts.push_back(read_shape(path, dimensions));
  }

  shape_table::value value_of(const raw_value& raw, const std::string& path, const shape_key& key) {
    taken_.insert(path);
    switch (key.kind) {
      case shape_value_kind::number: {
        const auto found = numbers_of(raw, path);
        if (found.size() != 1 || std::holds_alternative<raw_value::list>(raw.value))
          refuse(raw, path, "it must be a number", fmt::format("write for example {} = 0.5", key.name));
        return found.front();
      }
      case shape_value_kind::vector:
        return numbers_of(raw, path);
      case shape_value_kind::points: {
        std::vector<std::vector<double>> points;
        const auto* list = std::get_if<raw_value::list>(&raw.value);
        if (list == nullptr)
          refuse(raw, path, "it must be a list of points", "write for example [[0, 0], [1, 0], [0, 1]]");
        for (const raw_value& one : *list) points.push_back(numbers_of(one, path));
        return points;
      }
      default: {
        const auto* text = std::get_if<std::string>(&raw.value);
        if (text == nullptr)
          refuse(raw, path, "it must be a text", fmt::format("write for example {} = \"...\"", key.name));
        return *text;
      }
    }
  }

  /// Returns the numbers of a value, which may be formulas of constants.
  std::vector<double> numbers_of(const raw_value& raw, const std::string& path) const {
    return constant_numbers(raw, path, config_.constants);
  }

  void check_all_taken(const std::string& path, const shape_table& shape, int dimensions,
                       const std::vector<std::string>& of_wall) const {
    for (const auto& [other, raw] : text_.values) {
      if (other.rfind(path + ".", 0) != 0 || taken_.contains(other)) continue;
      std::vector<std::string> names = {"shape"};
      names.insert(names.end(), of_wall.begin(), of_wall.end());
      for (const shape_key& key : keys_of(find_shape(shape.shape), dimensions)) names.push_back(key.name);
      throw input_error(raw.place,
                        fmt::format("unknown key '{}' (shape '{}'{} such key); {}", shown(other), shape.shape,
                                    of_wall.empty() ? " has no" : " and its wall have no",
                                    suggest_variable(last_of(other), names)));
    }
  }

  const case_text& text_;
  const model& equation_;
  case_config& config_;
  std::set<std::string> taken_;
};

/// Returns the shape of a table.
std::shared_ptr<const shape> made_shape(const case_config& config, const shape_table& table,
                                        const std::string& path, int dimensions) {
  const shape_entry& entry = find_shape(table.shape);
  shape_values values;
  for (const shape_key& key : keys_of(entry, dimensions)) {
    if (const auto found = table.values.find(key.name); found != table.values.end()) {
      std::visit([&](const auto& one) { values[key.name] = one; }, found->second);
      if (key.kind == shape_value_kind::formula) {
        const source_place place = place_of(config, path + "." + key.name);
        const expression phi(std::get<std::string>(found->second), place,
                             formula_of_position(dimensions, false, config.constants));
        values[key.name] = level_set_function([phi](const position& x) { return phi.evaluate(x); });
      }
    }
    if (const auto found = table.parts.find(key.name); found != table.parts.end()) {
      shape_list parts;
      for (std::size_t k = 0; k < found->second.size(); ++k)
        parts.push_back(made_shape(config, found->second[k], fmt::format("{}.{}.{}", path, key.name, k + 1),
                                   key.planar ? 2 : dimensions));
      values[key.name] = std::move(parts);
    }
  }
  source_place place = place_of(config, path + ".shape");
  if (place.file.empty()) place = place_of(config, path);
  return at_place(place, [&] { return make_shape(table.shape, values, dimensions); });
}

/// Returns the kinds of walls with any normal that a model can have.
std::vector<std::string> kinds_of_bodies(const model& equation) {
  std::vector<std::string> names;
  for (const boundary_entry* entry : boundary_entries()) {
    if (!entry->any_normal) continue;
    try {
      if (entry->variables != nullptr)
        entry->variables(equation);
      else if (entry->make({&equation})->oblique(equation.velocities()) == nullptr)
        continue;
      names.push_back(fmt::format("\"{}\"", entry->name));
    } catch (const input_error&) {
      continue;  // not with this model
    }
  }
  return names;
}

std::array<bool, 3> periodic_directions_of(const case_config& config) {
  std::array<bool, 3> periodic{};
  for (std::size_t k = 0; k < config.space.cells.size(); ++k) {
    const boundary_entry& side = find_boundary(config.faces[2 * k].kind.value_or(config.space.boundary));
    periodic[k] = side.variables == nullptr && side.make({})->periodic();
  }
  return periodic;
}

}  // namespace

std::string why_no_wall_of_bodies(const std::string& kind, const model& equation) {
  const auto kinds = kinds_of_bodies(equation);
  return fmt::format(
      "a body cannot have the wall '{}' (its normal may have any direction); {}", kind,
      kinds.empty() ? "use another model" : fmt::format("write kind = {}", fmt::join(kinds, " or ")));
}

void read_bodies(const case_text& text, const model& equation, case_config& config) {
  reader_of_bodies(text, equation, config).read();
}

std::shared_ptr<const cut_cells> cut_cells_of(const case_config& config, const grid& mesh) {
  const std::array<bool, 3> periodic = periodic_directions_of(config);
  const auto make = [&] {
    std::vector<outside_function> bodies;
    for (std::size_t k = 0; k < config.bodies.size(); ++k) {
      const auto made = made_shape(config, config.bodies[k].shape, path_of_body(k), mesh.dimensions());
      bodies.emplace_back([made](const position& x) { return made->outside(x); });
    }
    try {
      return std::make_shared<const cut_cells>(mesh, bodies, periodic);
    } catch (const hidden_body& failure) {
      const std::size_t k = failure.body();
      throw input_error(
          place_of_emitter(config, path_of_body(k)),
          hidden_body::message(fmt::format("body '{}'", config.bodies[k].name), failure.reason()));
    } catch (const input_error& failure) {
      throw input_error(place_of_emitter(config, path_of_body(0)), failure.what());
    }
  };
  return config.parts->cut.get(
      {config.space.cells, config.space.domain, config.solids, config.bodies, periodic, config.constants},
      make);
}

}  // namespace apsis
