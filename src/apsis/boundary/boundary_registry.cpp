#include <apsis/boundary/boundary_registry.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

namespace apsis {

std::vector<std::string> boundary_names() {
  std::vector<std::string> names;
  for (const boundary_entry* entry : boundary_entries()) names.push_back(entry->name);
  return names;
}

const boundary_entry& find_boundary(const std::string& name) {
  for (const boundary_entry* entry : boundary_entries())
    if (entry->name == name) return *entry;
  throw input_error(fmt::format("unknown boundary '{}' (there is no such kind); {}", name.substr(0, 60),
                                suggest(name, boundary_names())));
}

std::optional<data_variable> variable_of(const std::string& kind, const model& equation,
                                         const std::string& variable) {
  const boundary_entry& entry = find_boundary(kind);
  if (entry.variables == nullptr) return std::nullopt;
  for (auto& one : entry.variables(equation))
    if (one.name == variable) return std::move(one);
  return std::nullopt;
}

namespace {

/// Throws input_error if a required variable has no value.
void check_absence(const std::string& kind, const data_variable& variable, const face_quantities& values,
                   const std::string& surface) {
  if (variable.value || values.contains(variable.alternative)) return;
  throw input_error(
      fmt::format("boundary '{}'{} has no value of '{}' (it is the {}); give one{}", kind,
                  surface.empty() ? "" : " of " + surface, variable.name, variable.doc,
                  variable.alternative.empty() ? "" : fmt::format(", or '{}'", variable.alternative)));
}

/// Throws input_error if a variable and its alternative both have values.
void check_alternatives(const std::string& kind, const data_variable& variable,
                        const face_quantities& values) {
  if (values.contains(variable.name) && values.contains(variable.alternative))
    throw input_error(
        fmt::format("boundary '{}' has values of '{}' and '{}' (each determines the other); "
                    "remove one",
                    kind, variable.name, variable.alternative));
}

}  // namespace

std::shared_ptr<const boundary> make_boundary(const std::string& name) {
  const boundary_entry& entry = find_boundary(name);
  if (entry.variables != nullptr)
    throw input_error(
        fmt::format("boundary '{}' needs a model (it prescribes components of its rows); give one", name));
  return entry.make({});
}

std::shared_ptr<const boundary> make_boundary(const std::string& name, const model& equation,
                                              const face_quantities& values, const std::string& surface) {
  const boundary_entry& entry = find_boundary(name);
  const auto variables =
      entry.variables != nullptr ? entry.variables(equation) : std::vector<data_variable>{};
  std::vector<std::string> names;
  for (const auto& variable : variables) names.push_back(variable.name);
  for (const auto& [given, components] : values)
    if (std::find(names.begin(), names.end(), given) == names.end())
      throw input_error(fmt::format("boundary '{}' has no variable '{}' (its variables have other names); {}",
                                    name, given.substr(0, 60),
                                    names.empty() ? "give none" : suggest(given, names)));
  boundary_source from{&equation};
  for (const auto& variable : variables) {
    check_alternatives(name, variable, values);
    const auto given = values.find(variable.name);
    if (given != values.end()) from.given.push_back(variable.name);
    const auto size = static_cast<std::size_t>(variable.size);
    if (given == values.end()) {
      check_absence(name, variable, values, surface);
      from.values.insert(from.values.end(), size, face_quantity(variable.value.value_or(0.0)));
    } else if (given->second.size() == size || given->second.size() == 1) {
      from.values.insert(from.values.end(), given->second.begin(), given->second.end());
      from.values.insert(from.values.end(), size - given->second.size(), face_quantity(0.0));
    } else {
      throw input_error(fmt::format("'{}' of boundary '{}' has {} components (the model has {}); give {}",
                                    variable.name, name, given->second.size(), size, size));
    }
  }
  return entry.make(from);
}

domain make_domain(const phase_space& space, const std::string& name) {
  const auto side = make_boundary(name);
  return {space, std::vector<domain::faces>(static_cast<std::size_t>(space.mesh.dimensions()), {side, side})};
}

}  // namespace apsis
