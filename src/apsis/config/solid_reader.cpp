#include <apsis/config/solid_reader.hpp>

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/config/boundary_reader.hpp>
#include <apsis/config/case_value.hpp>
#include <apsis/config/list_of_tables.hpp>
#include <apsis/config/suggest_variable.hpp>
#include <apsis/config/surface_names.hpp>
#include <apsis/model/expression.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

const std::string head = "space.solid.";

std::string path_of(std::size_t box) {
  return fmt::format("{}{}", head, box + 1);
}

/// Returns a corner of a box: one number, or constant formula, for each direction.
std::vector<double> corner(const raw_value& raw, const std::string& path, const case_config& config) {
  const std::size_t given = formula_texts(raw, path).size(), wanted = config.space.cells.size();
  if (given != wanted)
    refuse(raw, path,
           fmt::format("it has {} number{}, the space {} dimensions", given, given == 1 ? "" : "s", wanted),
           fmt::format("give {}", wanted));
  return constant_numbers(raw, path, config.constants);
}

/// Returns the index of the cell edge at a coordinate along a direction. Throws input_error without such an
/// edge.
int edge_at(const case_config& config, const grid& mesh, const std::string& path, int direction, double x) {
  const double from_start = (x - mesh.edge(direction, 0)) / mesh.spacing(direction);
  const int n = mesh.cells(direction);
  const double nearest = std::round(from_start);
  // Coordinates and edges are rounded numbers.
  constexpr double tolerance = 1e-6;
  if (std::abs(from_start - nearest) < tolerance && nearest >= 0.0 && nearest <= n)
    return static_cast<int>(nearest);
  const int below = static_cast<int>(std::clamp(std::floor(from_start), 0.0, n - 1.0));
  throw input_error(
      place_of(config, path),
      fmt::format("'{}' = {:g} along {} is not on an edge of the cells (the nearest are {:.6g} and {:.6g}); "
                  "move it, or change space.cells",
                  path, x, "xyz"[direction], mesh.edge(direction, below), mesh.edge(direction, below + 1)));
}

class reader_of_solids {
 public:
  reader_of_solids(const case_text& text, const model& equation, case_config& config)
      : text_(text), equation_(equation), config_(config) {}

  void read() {
    config_.solids.clear();
    // Kinds first: they determine the other valid keys.
    for (const bool kinds : {true, false})
      for (const auto& [path, raw] : text_.values)
        if (path.rfind(head, 0) == 0) take(path, raw, kinds);
    for (std::size_t box = 0; box < config_.solids.size(); ++box) complete(box);
  }

 private:
  void take(const std::string& path, const raw_value& raw, bool kinds) {
    const auto split = split_key(path, head);
    if (!split)
      throw input_error(raw.place, fmt::format("unknown key '{}' (solid boxes are a list of tables); write "
                                               "[[space.solid]]",
                                               shown(path)));
    if (config_.solids.size() < split->number) config_.solids.resize(split->number);
    solid_table& here = config_.solids[split->number - 1];
    const std::string& key = split->key;
    if ((key == "kind") != kinds) return;
    if (key == "kind" || key == "name") {
      const auto* text = std::get_if<std::string>(&raw.value);
      if (text == nullptr) refuse(raw, path, "it must be a text", "write for example kind = \"diffuse\"");
      (key == "kind" ? here.kind : here.name) = *text;
    } else if (key == "from" || key == "to") {
      (key == "from" ? here.from : here.to) = corner(raw, path, config_);
    } else {
      take_variable(path, key, raw, here);
    }
  }

  void take_variable(const std::string& path, const std::string& key, const raw_value& raw,
                     solid_table& here) {
    auto names = boundary_variables(here.kind, equation_, raw.place);
    if (std::find(names.begin(), names.end(), key) == names.end()) {
      names.insert(names.end(), {"name", "from", "to", "kind"});
      throw input_error(raw.place, fmt::format("unknown key '{}' (boundary '{}' has no such variable); {}",
                                               shown(path), here.kind, suggest_variable(key, names)));
    }
    here.values[key] = formula_texts(raw, path);
  }

  void complete(std::size_t box) {
    solid_table& here = config_.solids[box];
    const std::string path = path_of(box);
    if (here.name.empty()) here.name = fmt::format("solid-{}", box + 1);
    std::vector<std::string> earlier;
    for (std::size_t other = 0; other < box; ++other) earlier.push_back(config_.solids[other].name);
    check_surface_name(config_, path, here.name, earlier);
    for (const char* key : {"from", "to"})
      if ((key[0] == 'f' ? here.from : here.to).empty())
        throw input_error(
            place_of(config_, path),
            fmt::format("key '{}.{}' is missing (a box needs two corners); add for example "
                        "{} = [{}]",
                        path, key, key, fmt::join(std::vector<int>(config_.space.cells.size(), 0), ", ")));
  }

  const case_text& text_;
  const model& equation_;
  case_config& config_;
};

}  // namespace

void read_solids(const case_text& text, const model& equation, case_config& config) {
  reader_of_solids(text, equation, config).read();
}

std::vector<cell_box> solid_boxes(const case_config& config, const grid& mesh) {
  std::vector<cell_box> boxes;
  for (std::size_t k = 0; k < config.solids.size(); ++k) {
    const solid_table& solid = config.solids[k];
    cell_box box;
    for (int direction = 0; direction < mesh.dimensions(); ++direction) {
      const auto d = static_cast<std::size_t>(direction);
      const int begin = edge_at(config, mesh, path_of(k) + ".from", direction, solid.from[d]),
                end = edge_at(config, mesh, path_of(k) + ".to", direction, solid.to[d]);
      if (begin >= end)
        throw input_error(place_of(config, path_of(k) + ".to"),
                          fmt::format("'{}' has no extent along {} ({:g} to {:g}); give from < to",
                                      path_of(k), "xyz"[d], solid.from[d], solid.to[d]));
      box.first[d] = begin;
      box.cells[d] = end - begin;
    }
    boxes.push_back(box);
  }
  return boxes;
}

std::vector<std::shared_ptr<const boundary>> make_solid_walls(const case_config& config,
                                                              const std::shared_ptr<const model>& equation) {
  const auto make = [&] {
    std::vector<std::shared_ptr<const boundary>> walls;
    for (std::size_t k = 0; k < config.solids.size(); ++k)
      walls.push_back(
          make_wall(config, *equation, path_of(k), config.solids[k].kind, config.solids[k].values));
    for (std::size_t k = 0; k < config.bodies.size(); ++k)
      walls.push_back(make_wall(config, *equation, fmt::format("space.body.{}", k + 1), config.bodies[k].kind,
                                config.bodies[k].values));
    return walls;
  };
  return config.parts->walls.get({equation, "", {config.solids, config.bodies}, config.constants}, make);
}

}  // namespace apsis
