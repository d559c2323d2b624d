#include <apsis/body/shape_registry.hpp>
#include <apsis/core/errors.hpp>

#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace formula_shape {
namespace {

/// A shape with a given function φ, whose values it checks.
class level_set final : public shape {
 public:
  explicit level_set(level_set_function phi) : phi_(std::move(phi)) {}
  double outside(const position& x) const override {
    const double value = phi_(x);
    if (std::isfinite(value)) return value;
    throw input_error(
        fmt::format("'phi' of shape 'formula' is {} at ({}, {}, {}) (it is not finite); change the formula",
                    value, x[0], x[1], x[2]));
  }

 private:
  level_set_function phi_;
};

std::shared_ptr<const shape> make(const shape_arguments& from) {
  return std::make_shared<level_set>(from.formula("phi"));
}

}  // namespace
}  // namespace formula_shape

extern const shape_entry shape_formula;
const shape_entry shape_formula = {
    .name = "formula",
    .description = "all points where a formula is at most 0",
    .keys = {{.name = "phi",
              .doc = "continuous function, positive in the gas, near the surface about the distance",
              .kind = shape_value_kind::formula}},
    .make = formula_shape::make};

}  // namespace apsis
