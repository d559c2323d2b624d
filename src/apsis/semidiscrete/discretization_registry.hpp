#pragma once

#include <apsis/semidiscrete/discretization.hpp>

#include <string>
#include <vector>

namespace apsis {

/// A discretization of space: a file of semidiscrete/discretizations/ defines `extern const
/// discretization_entry discretization_<file>`.
struct discretization_entry {
  std::string name;                     ///< "finite-volume"
  std::string description;              ///< one line
  std::string source;                   ///< citation
  const discretization& (*instance)();  ///< returns the object, which lives as long as the program
};

/// Returns the single object of a discretization, for its entry.
template <class Discretization>
const discretization& instance_of() {
  static const Discretization one;
  return one;
}

/// Returns all discretizations, sorted by file name (generated).
std::vector<const discretization_entry*> discretization_entries();

/// Returns the names of all discretizations, the default on a line first.
std::vector<std::string> discretization_names();
/// Returns the names of the places at which cells of some discretization may collide.
std::vector<std::string> collision_place_names();

/// Returns the entry called `name`; nullptr for an unknown name.
const discretization_entry* try_find_discretization(const std::string& name);
/// Returns the entry called `name`. Throws input_error with the nearest name for an unknown one.
const discretization_entry& find_discretization(const std::string& name);
/// Returns the default on meshes of this many dimensions. It is finite volumes on a line, and otherwise
/// finite differences, also for a model without space.
const discretization_entry& default_discretization(int dimensions);

}  // namespace apsis
