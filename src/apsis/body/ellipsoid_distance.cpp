#include <apsis/body/ellipsoid_distance.hpp>

#include <apsis/body/internal/vectors.hpp>

#include <algorithm>
#include <cstddef>

namespace apsis {

double ellipsoid_distance(const position& x, const position& semi_axes, int dimensions) {
  position scaled = {}, slope = {};
  double least = semi_axes[0];
  for (std::size_t i = 0; i < static_cast<std::size_t>(dimensions); ++i) {
    scaled[i] = x[i] / semi_axes[i];
    slope[i] = scaled[i] / semi_axes[i];
    least = std::min(least, semi_axes[i]);
  }
  const double k = vectors::length(scaled), m = vectors::length(slope);
  if (m == 0.0) return -least;
  const double w = k / m;
  return (k - 1.0) * (k < 1.0 ? least + k * (w - least) : w);
}

}  // namespace apsis
