#include <apsis/body/shape_registry.hpp>

#include <memory>
#include <utility>

namespace apsis {
namespace hollow_shape {
namespace {

/// φ = −φ₀.
class hollow final : public shape {
 public:
  explicit hollow(std::shared_ptr<const shape> of) : of_(std::move(of)) {}
  double outside(const position& x) const override { return -of_->outside(x); }

 private:
  std::shared_ptr<const shape> of_;
};

std::shared_ptr<const shape> make(const shape_arguments& from) {
  return std::make_shared<hollow>(from.shapes("of").front());
}

}  // namespace
}  // namespace hollow_shape

extern const shape_entry shape_hollow;
const shape_entry shape_hollow = {.name = "hollow",
                                  .description = "all points outside a shape, which the gas fills",
                                  .keys = {{.name = "of",
                                            .doc = "list of the shape that contains the gas",
                                            .kind = shape_value_kind::shapes,
                                            .fewest = 1,
                                            .most = 1}},
                                  .make = hollow_shape::make};

}  // namespace apsis
