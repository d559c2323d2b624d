#include <apsis/body/ellipsoid_distance.hpp>
#include <apsis/body/internal/vectors.hpp>
#include <apsis/body/shape_registry.hpp>

#include <memory>

namespace apsis {
namespace ellipsoid_shape {
namespace {

/// A first-order approximation of the distance, by ellipsoid_distance().
class ellipsoid final : public shape {
 public:
  ellipsoid(const position& centre, const position& semi_axes) : centre_(centre), semi_axes_(semi_axes) {}
  double outside(const position& x) const override {
    return ellipsoid_distance(vectors::difference(x, centre_), semi_axes_, 3);
  }

 private:
  position centre_, semi_axes_;
};

std::shared_ptr<const shape> make(const shape_arguments& from) {
  return std::make_shared<ellipsoid>(from.vector("centre"), from.vector("semi_axes"));
}

}  // namespace
}  // namespace ellipsoid_shape

extern const shape_entry shape_ellipsoid;
const shape_entry shape_ellipsoid = {
    .name = "ellipsoid",
    .description = "ellipsoid in space",
    .keys = {{.name = "centre", .doc = "position of the centre", .kind = shape_value_kind::vector},
             {.name = "semi_axes",
              .doc = "three semi-axes, along x, y and z",
              .kind = shape_value_kind::vector,
              .positive = true}},
    .dimensions = {3},
    .alternative = "use 'ellipse'",
    .make = ellipsoid_shape::make};

}  // namespace apsis
