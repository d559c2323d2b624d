#pragma once

#include <apsis/phase/boundary.hpp>
#include <apsis/phase/domain.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// One kind of boundary: a file of boundary/kinds/ defines `extern const boundary_entry boundary_<file>`.
struct boundary_entry {
  std::string name;                     ///< "periodic", as case files have it
  std::string description;              ///< one line
  std::unique_ptr<boundary> (*make)();  ///< a new one
};

/// Every kind, sorted by file name (generated).
std::vector<const boundary_entry*> boundary_entries();

/// Names of all kinds: "outflow", "periodic", …
std::vector<std::string> boundary_names();

/// The boundary of that name. Throws input_error with the nearest name if there is none.
std::shared_ptr<const boundary> make_boundary(const std::string& name);

/// A phase space with the same kind of boundary at every face. Throws input_error as make_boundary() does.
domain make_domain(const phase_space& space, const std::string& name);

}  // namespace apsis
