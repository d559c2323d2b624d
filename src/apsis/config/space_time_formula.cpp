#include <apsis/config/space_time_formula.hpp>

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <array>

namespace apsis {
namespace {

/// t, the coordinates, the components of the velocity.
formula_kind kind_of(const formula_constants& constants, int space, int velocity) {
  static constexpr std::array<const char*, 3> names = {"v_x", "v_y", "v_z"};
  formula_kind kind = formula_of_position(space, false, constants);
  kind.variables.insert(kind.variables.begin(), "t");
  kind.variables.insert(kind.variables.end(), names.begin(), names.begin() + velocity);
  return kind;
}

/// A formula without t is one where that is an unknown name.
bool has_no_time(const std::string& text, formula_kind kind) {
  kind.variables.erase(kind.variables.begin());
  try {
    expression(text, {}, kind);
  } catch (const input_error&) {
    return false;
  }
  return true;
}

}  // namespace

space_time_formula::space_time_formula(const std::string& text, const source_place& place,
                                       const formula_constants& constants, int space, int velocity) {
  const formula_kind kind = kind_of(constants, space, velocity);
  formula_ = std::make_shared<const expression>(text, place, kind);
  velocity_ = static_cast<std::size_t>(velocity);
  space_ = kind.variables.size() - 1 - velocity_;
  steady_ = has_no_time(text, kind);
}

double space_time_formula::at(double t, const position& x, const position& v) const {
  std::array<double, 7> values{t};
  std::copy_n(x.begin(), space_, values.begin() + 1);
  std::copy_n(v.begin(), velocity_, values.begin() + 1 + static_cast<std::ptrdiff_t>(space_));
  return formula_->evaluate(values);
}

}  // namespace apsis
