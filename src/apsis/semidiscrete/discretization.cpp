#include <apsis/core/errors.hpp>
#include <apsis/core/printable.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/semidiscrete/discretization_registry.hpp>

#include <algorithm>

#include <fmt/format.h>

namespace apsis {

std::vector<std::string> discretization_names() {
  std::vector<std::string> names;
  for (const discretization_entry* entry : discretization_entries()) names.push_back(entry->name);
  const auto first = std::find(names.begin(), names.end(), default_discretization(1).name);
  std::rotate(names.begin(), first, first + 1);
  return names;
}

std::vector<std::string> collision_place_names() {
  std::vector<std::string> names;
  for (const discretization_entry* entry : discretization_entries())
    for (const std::string& place : entry->instance().collision_places())
      if (std::find(names.begin(), names.end(), place) == names.end()) names.push_back(place);
  return names;
}

const discretization_entry* try_find_discretization(const std::string& name) {
  for (const discretization_entry* entry : discretization_entries())
    if (entry->name == name) return entry;
  return nullptr;
}

const discretization_entry& find_discretization(const std::string& name) {
  if (const discretization_entry* found = try_find_discretization(name)) return *found;
  throw input_error(fmt::format("unknown formulation '{}' (there is no such name); {}", printable(name),
                                suggest(name, discretization_names())));
}

const discretization_entry& default_discretization(int dimensions) {
  return find_discretization(dimensions == 1 ? "finite-volume" : "finite-difference");
}

}  // namespace apsis
