#include <apsis/body/shape_registry.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>

namespace apsis {
namespace difference_shape {
namespace {

/// φ = max(φ₁, −φ₂, −φ₃, …).
class reduced final : public shape {
 public:
  explicit reduced(shape_list shapes) : shapes_(std::move(shapes)) {}
  double outside(const position& x) const override {
    double largest = shapes_.front()->outside(x);
    for (std::size_t k = 1; k < shapes_.size(); ++k) largest = std::max(largest, -shapes_[k]->outside(x));
    return largest;
  }

 private:
  shape_list shapes_;
};

std::shared_ptr<const shape> make(const shape_arguments& from) {
  return std::make_shared<reduced>(from.shapes("shapes"));
}

}  // namespace
}  // namespace difference_shape

extern const shape_entry shape_difference;
const shape_entry shape_difference = {.name = "difference",
                                      .description = "the first of several shapes without the others",
                                      .keys = {{.name = "shapes",
                                                .doc = "list of a shape and of those to remove from it",
                                                .kind = shape_value_kind::shapes,
                                                .fewest = 2}},
                                      .make = difference_shape::make};

}  // namespace apsis
