#pragma once

#include <algorithm>
#include <cmath>

namespace apsis {

/// Returns the signed distance of a point from the product of two sets in perpendicular spaces. a and b
/// are its signed distances from the two sets. The result is √(a² + b²) if both are positive, otherwise
/// max(a, b).
inline double combined_distance(double a, double b) {
  return a > 0.0 && b > 0.0 ? std::hypot(a, b) : std::max(a, b);
}

}  // namespace apsis
