#include <apsis/body/internal/simple_polygon.hpp>
#include <apsis/body/shape_registry.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace apsis {
namespace polygon_shape {
namespace {

/// The signed distance from a simple closed polygon. The sign follows from the number of edges that a ray
/// along x crosses: an odd number means inside. Each edge includes only one of its ends, so that a ray
/// through a corner is counted correctly.
class polygon final : public shape {
 public:
  explicit polygon(std::vector<position> corners) : corners_(std::move(corners)) {}

  double outside(const position& x) const override {
    double nearest = std::numeric_limits<double>::infinity();
    bool inside = false;
    for (std::size_t k = 0, last = corners_.size() - 1; k < corners_.size(); last = k++) {
      const position &a = corners_[last], &b = corners_[k];
      nearest = std::min(nearest, squared_distance(x, a, b));
      if ((a[1] > x[1]) != (b[1] > x[1]) && (turn_of(a, b, x) > 0.0) == (b[1] > a[1])) inside = !inside;
    }
    return inside ? -std::sqrt(nearest) : std::sqrt(nearest);
  }

 private:
  /// Returns the squared distance of x from the segment a b. The distance from the line vanishes exactly
  /// where the side of x changes.
  static double squared_distance(const position& x, const position& a, const position& b) {
    const double ux = b[0] - a[0], uy = b[1] - a[1], vx = x[0] - a[0], vy = x[1] - a[1];
    const double wx = x[0] - b[0], wy = x[1] - b[1];
    if (ux * vx + uy * vy <= 0.0) return vx * vx + vy * vy;
    if (ux * wx + uy * wy >= 0.0) return wx * wx + wy * wy;
    const double turn = turn_of(a, b, x);
    return turn * turn / (ux * ux + uy * uy);
  }

  std::vector<position> corners_;
};

std::shared_ptr<const shape> make(const shape_arguments& from) {
  std::vector<position> corners = from.points("points");
  if (corners.size() > 3 && corners.front() == corners.back()) corners.pop_back();
  check_simple_polygon(corners, from);
  return std::make_shared<polygon>(std::move(corners));
}

}  // namespace
}  // namespace polygon_shape

extern const shape_entry shape_polygon;
const shape_entry shape_polygon = {
    .name = "polygon",
    .description = "closed polygon in the plane, which does not intersect itself",
    .keys = {{.name = "points",
              .doc = "list of the corners, in either orientation",
              .kind = shape_value_kind::points,
              .fewest = 3}},
    .dimensions = {2},
    .alternative = "use 'extruded'",
    .make = polygon_shape::make};

}  // namespace apsis
