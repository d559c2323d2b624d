#include "command_registry.hpp"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

namespace apsis::app {

std::vector<const command_entry*> commands_in_order() {
  std::vector<const command_entry*> all = command_entries();
  std::sort(all.begin(), all.end(), [](const command_entry* a, const command_entry* b) {
    return std::tie(a->place, a->name) < std::tie(b->place, b->name);
  });
  return all;
}

std::string completed_from_list(const std::string& what) {
  return fmt::format("$(apsis list {} --names 2>/dev/null)", what);
}

}  // namespace apsis::app
