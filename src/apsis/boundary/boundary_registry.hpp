#pragma once

#include <apsis/phase/boundary.hpp>
#include <apsis/phase/domain.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// A kind of boundary condition: a file of boundary/kinds/ defines `extern const boundary_entry
/// boundary_<file>`.
struct boundary_entry {
  std::string name;                     ///< name in a case file: "periodic"
  std::string description;              ///< one line
  std::unique_ptr<boundary> (*make)();  ///< returns a new object
};

/// Returns all kinds, sorted by file name (generated).
std::vector<const boundary_entry*> boundary_entries();

/// Returns the names of all kinds: "outflow", "periodic", …
std::vector<std::string> boundary_names();

/// Returns the boundary of a kind. Throws input_error with the nearest name if there is no such kind.
std::shared_ptr<const boundary> make_boundary(const std::string& name);

/// Returns a domain with the same kind of boundary at every face. Throws input_error as make_boundary() does.
domain make_domain(const phase_space& space, const std::string& name);

}  // namespace apsis
