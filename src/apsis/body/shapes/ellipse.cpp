#include <apsis/body/ellipsoid_distance.hpp>
#include <apsis/body/placed_shape.hpp>
#include <apsis/body/shape_registry.hpp>

#include <memory>

namespace apsis {
namespace ellipse_shape {
namespace {

/// A first-order approximation of the distance, by ellipsoid_distance().
class ellipse final : public shape {
 public:
  explicit ellipse(const position& semi_axes) : semi_axes_(semi_axes) {}
  double outside(const position& x) const override { return ellipsoid_distance(x, semi_axes_, 2); }

 private:
  position semi_axes_;
};

std::shared_ptr<const shape> make(const shape_arguments& from) {
  return std::make_shared<placed_shape>(std::make_shared<ellipse>(from.vector("semi_axes")),
                                        rotation({0.0, 0.0, 1.0}, from.number("angle")),
                                        from.vector("centre"));
}

}  // namespace
}  // namespace ellipse_shape

extern const shape_entry shape_ellipse;
const shape_entry shape_ellipse = {
    .name = "ellipse",
    .description = "ellipse in the plane",
    .keys = {{.name = "centre", .doc = "position of the centre", .kind = shape_value_kind::vector},
             {.name = "semi_axes",
              .doc = "two semi-axes, along x and y for the angle 0",
              .kind = shape_value_kind::vector,
              .positive = true},
             {.name = "angle", .doc = "angle in degrees about the centre", .value = 0.0, .is_length = false}},
    .dimensions = {2},
    .alternative = "use 'ellipsoid'",
    .make = ellipse_shape::make};

}  // namespace apsis
