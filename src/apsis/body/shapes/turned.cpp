#include <apsis/body/shape_registry.hpp>

#include <cmath>
#include <memory>
#include <utility>

namespace apsis {
namespace turned_shape {
namespace {

/// A shape of the plane (x, r), revolved about the x axis: r = √(y² + z²).
class turned final : public shape {
 public:
  explicit turned(std::shared_ptr<const shape> of) : of_(std::move(of)) {}
  double outside(const position& x) const override {
    return of_->outside({x[0], std::hypot(x[1], x[2]), 0.0});
  }

 private:
  std::shared_ptr<const shape> of_;
};

std::shared_ptr<const shape> make(const shape_arguments& from) {
  return std::make_shared<turned>(from.shapes("of").front());
}

}  // namespace
}  // namespace turned_shape

extern const shape_entry shape_turned;
const shape_entry shape_turned = {
    .name = "turned",
    .description = "shape of the half plane (x, y > 0), revolved about the x axis",
    .keys = {{.name = "of",
              .doc = "list of the shape in the half plane, whose y is the distance from the axis",
              .kind = shape_value_kind::shapes,
              .fewest = 1,
              .most = 1,
              .planar = true}},
    .dimensions = {3},
    .alternative = "give the shape in its list 'of' alone, with space.geometry = \"axisymmetric\"",
    .make = turned_shape::make};

}  // namespace apsis
