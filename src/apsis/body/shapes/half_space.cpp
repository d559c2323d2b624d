#include <apsis/body/internal/vectors.hpp>
#include <apsis/body/shape_registry.hpp>

#include <memory>

namespace apsis {
namespace half_space_shape {
namespace {

/// φ = n·(x − p).
class half_space final : public shape {
 public:
  half_space(const position& point, const position& normal) : point_(point), normal_(normal) {}
  double outside(const position& x) const override {
    return vectors::dot(normal_, vectors::difference(x, point_));
  }

 private:
  position point_, normal_;
};

std::shared_ptr<const shape> make(const shape_arguments& from) {
  return std::make_shared<half_space>(from.vector("point"), from.direction("normal"));
}

}  // namespace
}  // namespace half_space_shape

extern const shape_entry shape_half_space;
const shape_entry shape_half_space = {
    .name = "half_space",
    .description = "all points behind a plane, or behind a line in the plane",
    .keys = {{.name = "point", .doc = "point of the surface", .kind = shape_value_kind::vector},
             {.name = "normal",
              .doc = "vector into the gas",
              .kind = shape_value_kind::vector,
              .is_length = false}},
    .make = half_space_shape::make};

}  // namespace apsis
