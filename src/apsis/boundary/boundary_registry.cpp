#include <apsis/boundary/boundary_registry.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>

#include <algorithm>
#include <cstddef>

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

bool is_of_velocity(const std::string& kind, const model& equation, const std::string& variable) {
  const boundary_entry& entry = find_boundary(kind);
  if (entry.variables == nullptr) return false;
  const auto all = entry.variables(equation);
  return std::any_of(all.begin(), all.end(),
                     [&](const data_variable& one) { return one.name == variable && one.of_velocity; });
}

std::shared_ptr<const boundary> make_boundary(const std::string& name) {
  const boundary_entry& entry = find_boundary(name);
  if (entry.variables != nullptr)
    throw input_error(
        fmt::format("boundary '{}' needs a model (it prescribes components of its rows); give one", name));
  return entry.make({});
}

std::shared_ptr<const boundary> make_boundary(const std::string& name, const model& equation,
                                              const face_quantities& values) {
  const boundary_entry& entry = find_boundary(name);
  const auto variables =
      entry.variables != nullptr ? entry.variables(equation) : std::vector<data_variable>{};
  std::vector<std::string> names;
  for (const auto& variable : variables) names.push_back(variable.name);
  for (const auto& [given, components] : values)
    if (std::find(names.begin(), names.end(), given) == names.end())
      throw input_error(fmt::format("boundary '{}' has no variable '{}'; {}", name, given.substr(0, 60),
                                    names.empty() ? "give none" : suggest(given, names)));
  boundary_source from{&equation, {}};
  for (const auto& variable : variables) {
    const auto given = values.find(variable.name);
    const auto size = static_cast<std::size_t>(variable.size);
    if (given == values.end() && !variable.value)
      throw input_error(fmt::format("boundary '{}' has no value of '{}' (it is the {}); give one", name,
                                    variable.name, variable.doc));
    if (given == values.end()) {
      from.values.insert(from.values.end(), size, face_quantity(*variable.value));
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
