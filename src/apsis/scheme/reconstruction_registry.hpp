#pragma once

#include <apsis/scheme/reconstruction.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// A reconstruction scheme: a file of scheme/reconstructions/ defines `extern
/// const reconstruction_entry reconstruction_<file>`.
struct reconstruction_entry {
  std::string name;         ///< "weno5-z"
  std::string description;  ///< one line
  std::string source;       ///< citation
  bool linear = false;      ///< whether edge values are linear in the data
  bool settles = false;     ///< whether a nonlinear scheme reaches steady states even if f jumps along rays
  std::unique_ptr<reconstruction> (*make)();  ///< makes an instance; schemes have no parameters
};

/// Returns all schemes, sorted by file name (generated).
std::vector<const reconstruction_entry*> reconstruction_entries();

/// Returns the entry called `name`; nullptr for an unknown name.
const reconstruction_entry* try_find_reconstruction(const std::string& name);
/// Returns the entry called `name`. Throws input_error with the nearest name for an unknown one.
const reconstruction_entry& find_reconstruction(const std::string& name);

}  // namespace apsis
