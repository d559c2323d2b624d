#include <apsis/body/internal/combined_distance.hpp>
#include <apsis/body/shape_registry.hpp>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace extruded_shape {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// A shape of the plane (x, y), continued along z.
class extruded final : public shape {
 public:
  extruded(std::shared_ptr<const shape> of, double from, double to)
      : of_(std::move(of)), from_(from), to_(to) {}
  double outside(const position& x) const override {
    return combined_distance(of_->outside({x[0], x[1], 0.0}), std::max(from_ - x[2], x[2] - to_));
  }

 private:
  std::shared_ptr<const shape> of_;
  double from_, to_;
};

std::shared_ptr<const shape> make(const shape_arguments& from) {
  const double low = from.number("from"), high = from.number("to");
  if (!(low < high))
    from.refuse("to", fmt::format("is {} ('from' is {})", high, low), "give a larger number");
  return std::make_shared<extruded>(from.shapes("of").front(), low, high);
}

}  // namespace
}  // namespace extruded_shape

extern const shape_entry shape_extruded;
const shape_entry shape_extruded = {.name = "extruded",
                                    .description = "shape of the plane (x, y), continued along z",
                                    .keys = {{.name = "of",
                                              .doc = "list of the shape in the plane",
                                              .kind = shape_value_kind::shapes,
                                              .fewest = 1,
                                              .most = 1,
                                              .planar = true},
                                             {.name = "from",
                                              .doc = "z of the lower end, infinite by default",
                                              .value = -extruded_shape::infinite},
                                             {.name = "to",
                                              .doc = "z of the upper end, infinite by default",
                                              .value = extruded_shape::infinite}},
                                    .dimensions = {3},
                                    .alternative = "give the shape in its list 'of' alone",
                                    .make = extruded_shape::make};

}  // namespace apsis
