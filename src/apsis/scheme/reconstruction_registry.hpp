#pragma once

#include <apsis/scheme/reconstruction.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// One scheme: a file of scheme/reconstructions/ defines `extern const reconstruction_entry
/// reconstruction_<file>`.
struct reconstruction_entry {
  std::string name;                           ///< "weno5-z"
  std::string description;                    ///< one line
  std::string source;                         ///< citation
  std::unique_ptr<reconstruction> (*make)();  ///< a new one; it has no parameters
};

/// Every scheme, sorted by file name (generated).
std::vector<const reconstruction_entry*> reconstruction_entries();

/// The entry called `name`; nullptr if there is none.
const reconstruction_entry* find_reconstruction(const std::string& name);

}  // namespace apsis
