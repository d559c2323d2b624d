#pragma once

#include <array>

namespace apsis {

/// A point of space; coordinates beyond the dimensions of the mesh are 0.
using position = std::array<double, 3>;

}  // namespace apsis
