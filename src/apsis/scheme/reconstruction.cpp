#include <apsis/scheme/reconstruction_registry.hpp>

namespace apsis {

const reconstruction_entry* find_reconstruction(const std::string& name) {
  for (const reconstruction_entry* entry : reconstruction_entries())
    if (entry->name == name) return entry;
  return nullptr;
}

}  // namespace apsis
