#include <apsis/body/shape_registry.hpp>

#include <algorithm>
#include <memory>
#include <utility>

namespace apsis {
namespace union_shape {
namespace {

/// φ = min φ_k.
class united final : public shape {
 public:
  explicit united(shape_list shapes) : shapes_(std::move(shapes)) {}
  double outside(const position& x) const override {
    double least = shapes_.front()->outside(x);
    for (const auto& one : shapes_) least = std::min(least, one->outside(x));
    return least;
  }

 private:
  shape_list shapes_;
};

std::shared_ptr<const shape> make(const shape_arguments& from) {
  return std::make_shared<united>(from.shapes("shapes"));
}

}  // namespace
}  // namespace union_shape

extern const shape_entry shape_union;
const shape_entry shape_union = {.name = "union",
                                 .description = "all points of several shapes",
                                 .keys = {{.name = "shapes",
                                           .doc = "list of shapes to unite",
                                           .kind = shape_value_kind::shapes,
                                           .fewest = 1}},
                                 .make = union_shape::make};

}  // namespace apsis
