// A square on its corner. This file has everything that a shape needs.
#include <apsis/body/shape_registry.hpp>

#include <cmath>
#include <memory>
#include <numbers>

namespace apsis {
namespace planted_diamond_shape {
namespace {

/// φ = (|x − a| + |y − b| − r)/√2.
class diamond final : public shape {
 public:
  diamond(const position& centre, double radius) : centre_(centre), radius_(radius) {}
  double outside(const position& x) const override {
    return (std::abs(x[0] - centre_[0]) + std::abs(x[1] - centre_[1]) - radius_) / std::numbers::sqrt2;
  }

 private:
  position centre_;
  double radius_;
};

std::shared_ptr<const shape> make(const shape_arguments& from) {
  return std::make_shared<diamond>(from.vector("centre"), from.number("radius"));
}

}  // namespace
}  // namespace planted_diamond_shape

extern const shape_entry shape_planted_diamond;
const shape_entry shape_planted_diamond = {
    .name = "planted-diamond",
    .description = "square on its corner",
    .keys = {{.name = "centre", .doc = "position of the centre", .kind = shape_value_kind::vector},
             {.name = "radius", .doc = "distance of the corners from the centre", .positive = true}},
    .dimensions = {2},
    .alternative = "polygon",
    .make = planted_diamond_shape::make};

}  // namespace apsis
