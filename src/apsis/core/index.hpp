#pragma once

#include <cstddef>

namespace apsis {

/// Returns an index k ≥ 0 in the type of the standard containers.
constexpr std::size_t at(int k) {
  return static_cast<std::size_t>(k);
}

}  // namespace apsis
