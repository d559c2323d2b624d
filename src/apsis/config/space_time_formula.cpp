#include <apsis/config/space_time_formula.hpp>

#include <algorithm>
#include <array>

namespace apsis {
namespace {

/// Returns the variables of a formula: t, the coordinates, the components of the velocity, and
/// those of the state.
formula_kind kind_of(const formula_constants& constants, int space, int velocity,
                     const std::vector<std::string>& state) {
  static constexpr std::array<const char*, 3> names = {"v_x", "v_y", "v_z"};
  formula_kind kind = formula_of_position(space, false, constants);
  kind.variables.insert(kind.variables.begin(), "t");
  kind.variables.insert(kind.variables.end(), names.begin(), names.begin() + velocity);
  kind.variables.insert(kind.variables.end(), state.begin(), state.end());
  return kind;
}

}  // namespace

space_time_formula::space_time_formula(const std::string& text, const source_place& place,
                                       const formula_constants& constants, int space, int velocity,
                                       const std::vector<std::string>& state) {
  const formula_kind kind = kind_of(constants, space, velocity, state);
  formula_ = std::make_shared<const expression>(text, place, kind);
  further_ = static_cast<std::size_t>(velocity) + state.size();
  space_ = kind.variables.size() - 1 - further_;
  steady_ = !formula_->uses("t");
  for (std::size_t k = 1; k <= space_; ++k) uniform_ = uniform_ && !formula_->uses(kind.variables[k]);
}

space_time_formula::values space_time_formula::arguments(double t, const position& x,
                                                         std::span<const double> further) const {
  values all{t};
  std::copy_n(x.begin(), space_, all.begin() + 1);
  std::copy_n(further.begin(), further_, all.begin() + 1 + static_cast<std::ptrdiff_t>(space_));
  return all;
}

double space_time_formula::at(double t, const position& x, const position& v) const {
  return formula_->evaluate(arguments(t, x, v));
}

double space_time_formula::at_state(double t, const position& x, std::span<const double> state) const {
  return formula_->value(arguments(t, x, state));
}

}  // namespace apsis
