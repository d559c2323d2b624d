#include <apsis/core/errors.hpp>
#include <apsis/velocity/velocity_line_registry.hpp>

#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis {
namespace graded_line {
namespace {

/// Returns velocities v = max s³ at midpoints of equal intervals of s ∈ [−1, 1], with weights v'(s) Δs. The
/// first and third derivatives of the integrand f v' of each half vanish at s = 0. The midpoint rule
/// therefore has sixth order, even if f jumps at v = 0.
velocity_line make(int points, double max) {
  if (points % 2 != 0)
    throw input_error(fmt::format("velocity.points = {} cannot be graded towards 0 (it is odd); give {}",
                                  points, points + 1));
  if (!(max > 0.0) || !std::isfinite(max))
    throw input_error("velocity.max cannot be used (it is not positive and finite); give max > 0");
  std::vector<double> v, w;
  for (int j = 0; j < points; ++j) {
    const double s = (2.0 * j + 1.0 - points) / points;
    v.push_back(max * s * s * s);
    w.push_back(3.0 * max * s * s * (2.0 / points));
  }
  return {std::move(v), std::move(w)};
}

}  // namespace
}  // namespace graded_line

extern const velocity_line_entry velocity_line_graded;
const velocity_line_entry velocity_line_graded = {
    .name = "graded",
    .description = "max s^3 at midpoints of equal intervals of s: for walls, where f jumps at v = 0",
    .source = "midpoint rule after a change of variables",
    .make = graded_line::make};

}  // namespace apsis
