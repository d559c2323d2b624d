#include <apsis/body/internal/combined_distance.hpp>
#include <apsis/body/internal/vectors.hpp>
#include <apsis/body/shape_registry.hpp>

#include <cmath>
#include <limits>
#include <memory>

namespace apsis {
namespace cylinder_shape {
namespace {

/// The signed distance from a round cylinder with flat ends, or without ends.
class cylinder final : public shape {
 public:
  cylinder(const position& centre, const position& axis, double radius, double length)
      : centre_(centre), axis_(axis), radius_(radius), half_(0.5 * length) {}
  double outside(const position& x) const override {
    const position y = vectors::difference(x, centre_);
    // The length of the cross product is accurate even close to the axis.
    const double across = vectors::length(vectors::cross(axis_, y)) - radius_;
    return combined_distance(across, std::abs(vectors::dot(axis_, y)) - half_);
  }

 private:
  position centre_, axis_;
  double radius_, half_;
};

std::shared_ptr<const shape> make(const shape_arguments& from) {
  return std::make_shared<cylinder>(from.vector("centre"), from.direction("axis"), from.number("radius"),
                                    from.number("length"));
}

}  // namespace
}  // namespace cylinder_shape

extern const shape_entry shape_cylinder;
const shape_entry shape_cylinder = {
    .name = "cylinder",
    .description = "round cylinder with flat ends, or without ends",
    .keys = {{.name = "centre", .doc = "point halfway between the ends", .kind = shape_value_kind::vector},
             {.name = "axis",
              .doc = "vector along the axis",
              .kind = shape_value_kind::vector,
              .is_length = false},
             {.name = "radius", .doc = "distance of the surface from the axis", .positive = true},
             {.name = "length",
              .doc = "distance of the ends, infinite by default",
              .value = std::numeric_limits<double>::infinity(),
              .positive = true}},
    .dimensions = {3},
    .alternative = "use 'circle'",
    .make = cylinder_shape::make};

}  // namespace apsis
