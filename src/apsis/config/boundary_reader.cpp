#include <apsis/config/boundary_reader.hpp>

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/config/case_value.hpp>
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

/// Calls body() and adds a place to its input errors.
template <class Body>
auto at_place(const source_place& place, const Body& body) {
  try {
    return body();
  } catch (const input_error& failure) {
    throw input_error(place, failure.what());
  }
}

/// Names of the variables of a kind of boundary.
std::vector<std::string> variables_of(const std::string& kind, const model& equation) {
  std::vector<std::string> names;
  const boundary_entry& entry = find_boundary(kind);
  if (entry.variables == nullptr) return names;
  for (const auto& variable : entry.variables(equation)) names.push_back(variable.name);
  return names;
}

/// A formula in t and the position, a number where it is constant.
face_quantity compile(const std::string& text, const source_place& place, const formula_kind& kind) {
  const auto formula = std::make_shared<const expression>(text, place, kind);
  if (formula->is_constant()) return formula->evaluate(std::array<double, 4>{});
  return face_quantity([formula](double t, const position& x) {
    return formula->evaluate(std::array<double, 4>{t, x[0], x[1], x[2]});
  });
}

/// A formula in t, the position and the velocity v_x, v_y, v_z.
face_quantity compile_of_velocity(const std::string& text, const source_place& place, formula_kind kind,
                                  int dimensions) {
  static const std::array<const char*, 3> names = {"v_x", "v_y", "v_z"};
  const std::size_t of_place = kind.variables.size() - 1, d = static_cast<std::size_t>(dimensions);
  kind.variables.insert(kind.variables.end(), names.begin(), names.begin() + dimensions);
  const auto formula = std::make_shared<const expression>(text, place, kind);
  if (formula->is_constant()) return formula->evaluate(std::array<double, 7>{});
  return face_quantity([formula, of_place, d](double t, const position& x, const position& v) {
    std::array<double, 7> values{t};
    std::copy_n(x.begin(), of_place, values.begin() + 1);
    std::copy_n(v.begin(), d, values.begin() + 1 + static_cast<std::ptrdiff_t>(of_place));
    return formula->evaluate(values);
  });
}

/// Whether a variable of a kind of boundary is a function of the velocity.
bool is_of_velocity(const std::string& kind, const model& equation, const std::string& variable) {
  const boundary_entry& entry = find_boundary(kind);
  if (entry.variables == nullptr) return false;
  const auto all = entry.variables(equation);
  return std::any_of(all.begin(), all.end(),
                     [&](const data_variable& one) { return one.name == variable && one.of_velocity; });
}

std::shared_ptr<const boundary> make_face(const case_config& config, const model& equation,
                                          const std::string& side, const face_table& table) {
  formula_kind kind = formula_of_position(equation.space_dimensions(), false, config.constants);
  kind.variables.insert(kind.variables.begin(), "t");
  face_quantities values;
  for (const auto& [name, formulas] : table.values)
    for (const auto& formula : formulas) {
      const source_place at = place_of(config, fmt::format("boundary.{}.{}", side, name));
      values[name].push_back(is_of_velocity(kind_of(config, table), equation, name)
                                 ? compile_of_velocity(formula, at, kind, equation.velocities().dimensions())
                                 : compile(formula, at, kind));
    }
  source_place place = place_of(config, "boundary." + side);
  if (place.file.empty())  // not a table of the file
    place = place_of(config, table.kind ? "boundary." + side + ".kind" : "space.boundary");
  return at_place(place, [&] { return make_boundary(kind_of(config, table), equation, values); });
}

}  // namespace

void read_boundary_values(const case_text& text, const model& equation, case_config& config) {
  const std::string head = "boundary.";
  for (const auto& [path, raw] : text.values) {
    if (path.rfind(head, 0) != 0) continue;
    const auto dot = path.find('.', head.size());
    const std::string side = path.substr(head.size(), dot == std::string::npos ? dot : dot - head.size());
    const std::string name = dot == std::string::npos ? "" : path.substr(dot + 1);
    const bool known = side == "left" || side == "right";
    if (name.empty() || !known)
      throw input_error(raw.place, fmt::format("unknown key '{}' (a face is a table [boundary.left] or "
                                               "[boundary.right]); {}",
                                               shown(path),
                                               known ? fmt::format("write [boundary.{}]", side)
                                                     : suggest(side, {"left", "right"})));
    if (name == "kind") continue;
    face_table& table = side == "left" ? config.faces.left : config.faces.right;
    const std::string& kind = kind_of(config, table);
    auto names = at_place(raw.place, [&] { return variables_of(kind, equation); });
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      names.emplace_back("kind");
      throw input_error(raw.place, fmt::format("unknown key '{}' (boundary '{}' has no such variable); {}",
                                               shown(path), kind, suggest(name, names)));
    }
    table.values[name] = formula_texts(raw, path);
  }
}

std::vector<domain::faces> make_boundaries(const case_config& config, const model& equation) {
  const face_table common;
  std::vector<domain::faces> sides;
  for (std::size_t k = 0; k < config.space.cells.size(); ++k) {
    const bool along_x = k == 0;
    sides.push_back({make_face(config, equation, "left", along_x ? config.faces.left : common),
                     make_face(config, equation, "right", along_x ? config.faces.right : common)});
  }
  return sides;
}

}  // namespace apsis
