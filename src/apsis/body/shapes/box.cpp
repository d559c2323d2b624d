#include <apsis/body/internal/vectors.hpp>
#include <apsis/body/shape_registry.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>

#include <fmt/format.h>

namespace apsis {
namespace box_shape {
namespace {

/// The signed distance from a box along the axes. It is exactly 0 on the faces.
class box final : public shape {
 public:
  box(const position& from, const position& to, int dimensions)
      : from_(from), to_(to), dimensions_(static_cast<std::size_t>(dimensions)) {}
  double outside(const position& x) const override {
    position beyond = {};
    double farthest = std::max(from_[0] - x[0], x[0] - to_[0]);
    for (std::size_t k = 0; k < dimensions_; ++k) {
      const double past = std::max(from_[k] - x[k], x[k] - to_[k]);
      farthest = std::max(farthest, past);
      beyond[k] = std::max(past, 0.0);
    }
    return farthest <= 0.0 ? farthest : vectors::length(beyond);
  }

 private:
  position from_, to_;
  std::size_t dimensions_;
};

std::shared_ptr<const shape> make(const shape_arguments& from) {
  const position low = from.vector("from"), high = from.vector("to");
  for (std::size_t k = 0; k < static_cast<std::size_t>(from.dimensions()); ++k)
    if (!(low[k] < high[k]))
      from.refuse("to", fmt::format("is {} in direction {} ('from' is {})", high[k], "xyz"[k], low[k]),
                  "give a larger number");
  return std::make_shared<box>(low, high, from.dimensions());
}

}  // namespace
}  // namespace box_shape

extern const shape_entry shape_box;
const shape_entry shape_box = {
    .name = "box",
    .description = "rectangle or box along the axes",
    .keys = {{.name = "from",
              .doc = "corner with the smallest coordinates",
              .kind = shape_value_kind::vector},
             {.name = "to", .doc = "corner with the largest coordinates", .kind = shape_value_kind::vector}},
    .make = box_shape::make};

}  // namespace apsis
