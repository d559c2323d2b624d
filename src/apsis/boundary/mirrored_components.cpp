#include <apsis/boundary/mirrored_components.hpp>

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>

#include <fmt/format.h>

namespace apsis {

std::vector<int> mirrored_components(const velocity_set& velocities, int direction) {
  const auto n = static_cast<std::size_t>(velocities.size());
  using point = std::array<double, 3>;
  const auto velocity = [&](std::size_t j, double sign) {
    point v{};
    for (int k = 0; k < velocities.dimensions(); ++k) {
      const double value = velocities.speeds(k)[j];
      v[static_cast<std::size_t>(k)] = k == direction ? sign * value : value;  // −0 compares equal to 0
    }
    return v;
  };
  std::vector<std::size_t> sorted(n);
  std::iota(sorted.begin(), sorted.end(), std::size_t{0});
  std::sort(sorted.begin(), sorted.end(),
            [&](std::size_t a, std::size_t b) { return velocity(a, 1.0) < velocity(b, 1.0); });
  std::vector<int> mirrored(n * static_cast<std::size_t>(velocities.sets()));
  for (std::size_t j = 0; j < n; ++j) {
    const point wanted = velocity(j, -1.0);
    const auto found = std::lower_bound(sorted.begin(), sorted.end(), wanted,
                                        [&](std::size_t a, const point& v) { return velocity(a, 1.0) < v; });
    if (found == sorted.end() || velocity(*found, 1.0) != wanted ||
        velocities.weights()[*found] != velocities.weights()[j])
      throw input_error(
          fmt::format("the velocities are not symmetric (the one with v = {:g} in direction {} has no "
                      "mirror image of the same weight); use a symmetric velocity set or another "
                      "boundary",
                      velocities.speeds(direction)[j], direction + 1));
    for (std::size_t s = 0; s < static_cast<std::size_t>(velocities.sets()); ++s)
      mirrored[s * n + j] = static_cast<int>(s * n + *found);
  }
  return mirrored;
}

}  // namespace apsis
