#include <apsis/boundary/boundary_registry.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>

#include <cstddef>

#include <fmt/format.h>

namespace apsis {

std::vector<std::string> boundary_names() {
  std::vector<std::string> names;
  for (const boundary_entry* entry : boundary_entries()) names.push_back(entry->name);
  return names;
}

std::shared_ptr<const boundary> make_boundary(const std::string& name) {
  for (const boundary_entry* entry : boundary_entries())
    if (entry->name == name) return entry->make();
  throw input_error(fmt::format("unknown boundary '{}' (there is no such kind); {}", name.substr(0, 60),
                                suggest(name, boundary_names())));
}

domain make_domain(const phase_space& space, const std::string& name) {
  const auto side = make_boundary(name);
  return {space, std::vector<domain::faces>(static_cast<std::size_t>(space.mesh.dimensions()), {side, side})};
}

}  // namespace apsis
