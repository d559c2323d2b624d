#pragma once

#include <cstddef>
#include <string>

namespace apsis {

/// Name of component k of a vector with `dimensions` components in results: NAME itself if there is only one,
/// otherwise NAME_x, NAME_y or NAME_z.
inline std::string component_name(const std::string& name, int k, int dimensions) {
  return dimensions == 1 ? name : name + '_' + "xyz"[static_cast<std::size_t>(k)];
}

}  // namespace apsis
