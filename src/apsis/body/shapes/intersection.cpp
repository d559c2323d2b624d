#include <apsis/body/shape_registry.hpp>

#include <algorithm>
#include <memory>
#include <utility>

namespace apsis {
namespace intersection_shape {
namespace {

/// φ = max φ_k.
class intersected final : public shape {
 public:
  explicit intersected(shape_list shapes) : shapes_(std::move(shapes)) {}
  double outside(const position& x) const override {
    double largest = shapes_.front()->outside(x);
    for (const auto& one : shapes_) largest = std::max(largest, one->outside(x));
    return largest;
  }

 private:
  shape_list shapes_;
};

std::shared_ptr<const shape> make(const shape_arguments& from) {
  return std::make_shared<intersected>(from.shapes("shapes"));
}

}  // namespace
}  // namespace intersection_shape

extern const shape_entry shape_intersection;
const shape_entry shape_intersection = {.name = "intersection",
                                        .description = "points that several shapes have in common",
                                        .keys = {{.name = "shapes",
                                                  .doc = "list of shapes to intersect",
                                                  .kind = shape_value_kind::shapes,
                                                  .fewest = 1}},
                                        .make = intersection_shape::make};

}  // namespace apsis
