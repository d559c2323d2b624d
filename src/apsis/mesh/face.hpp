#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace apsis {

/// A face of a box: its lower or upper end along a direction.
struct face {
  int direction = 0;   ///< 0, 1 or 2
  bool upper = false;  ///< whether it is the end with the largest coordinate

  /// Returns the number of the face, 0 … 5. The lower face of a direction comes first.
  std::size_t index() const { return 2 * static_cast<std::size_t>(direction) + (upper ? 1 : 0); }
  /// Returns the unit vector normal to the face that points into the box.
  std::array<double, 3> inward_normal() const {
    std::array<double, 3> n{};
    n[static_cast<std::size_t>(direction)] = upper ? -1.0 : 1.0;
    return n;
  }
};

/// Names of the faces in the order of face::index().
inline const std::array<std::string, 6> face_names = {"left", "right", "bottom", "top", "back", "front"};

/// Returns the face with an index 0 … 5.
inline face face_of(std::size_t index) {
  return {static_cast<int>(index / 2), index % 2 == 1};
}

}  // namespace apsis
