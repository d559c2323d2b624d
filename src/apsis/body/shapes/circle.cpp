#include <apsis/body/shape_registry.hpp>

#include <cmath>
#include <memory>

namespace apsis {
namespace circle_shape {
namespace {

/// φ = |x − c| − r.
class circle final : public shape {
 public:
  circle(const position& centre, double radius) : centre_(centre), radius_(radius) {}
  double outside(const position& x) const override {
    return std::hypot(x[0] - centre_[0], x[1] - centre_[1]) - radius_;
  }

 private:
  position centre_;
  double radius_;
};

std::shared_ptr<const shape> make(const shape_arguments& from) {
  return std::make_shared<circle>(from.vector("centre"), from.number("radius"));
}

}  // namespace
}  // namespace circle_shape

extern const shape_entry shape_circle;
const shape_entry shape_circle = {
    .name = "circle",
    .description = "disk in the plane",
    .keys = {{.name = "centre", .doc = "position of the centre", .kind = shape_value_kind::vector},
             {.name = "radius", .doc = "distance of the surface from the centre", .positive = true}},
    .dimensions = {2},
    .alternative = "use 'cylinder'",
    .make = circle_shape::make};

}  // namespace apsis
