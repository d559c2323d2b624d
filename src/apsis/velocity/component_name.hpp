#pragma once

#include <cstddef>
#include <string>

namespace apsis {

/// Returns the name of component k of a vector in results. It is NAME itself if `dimensions` is 1, otherwise
/// NAME_x, NAME_y or NAME_z.
inline std::string component_name(const std::string& name, int k, int dimensions) {
  return dimensions == 1 ? name : name + '_' + "xyz"[static_cast<std::size_t>(k)];
}

}  // namespace apsis
