#include <apsis/body/internal/vectors.hpp>
#include <apsis/body/shape_registry.hpp>

#include <memory>

namespace apsis {
namespace sphere_shape {
namespace {

/// φ = |x − c| − r.
class sphere final : public shape {
 public:
  sphere(const position& centre, double radius) : centre_(centre), radius_(radius) {}
  double outside(const position& x) const override {
    return vectors::length(vectors::difference(x, centre_)) - radius_;
  }

 private:
  position centre_;
  double radius_;
};

std::shared_ptr<const shape> make(const shape_arguments& from) {
  return std::make_shared<sphere>(from.vector("centre"), from.number("radius"));
}

}  // namespace
}  // namespace sphere_shape

extern const shape_entry shape_sphere;
const shape_entry shape_sphere = {
    .name = "sphere",
    .description = "ball in space",
    .keys = {{.name = "centre", .doc = "position of the centre", .kind = shape_value_kind::vector},
             {.name = "radius", .doc = "distance of the surface from the centre", .positive = true}},
    .dimensions = {3},
    .alternative = "use 'circle'",
    .make = sphere_shape::make};

}  // namespace apsis
