#pragma once

#include <apsis/config/case.hpp>
#include <apsis/model/expression.hpp>
#include <apsis/velocity/position.hpp>

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// A formula of a case in the time t, the position and, optionally, the velocity v_x, v_y, v_z.
/// Dimensionless. Thread-safe.
class space_time_formula {
 public:
  /// `space` and `velocity` are the numbers of dimensions. `state` names further variables in place of the
  /// velocity. Throws input_error at `place` for wrong syntax or an unknown name.
  space_time_formula(const std::string& text, const source_place& place, const formula_constants& constants,
                     int space, int velocity = 0, const std::vector<std::string>& state = {});

  /// Returns the value. Throws input_error if it is not finite.
  double at(double t, const position& x, const position& v = {}) const;
  /// Returns the value at a state; NaN if the formula has none.
  double at_state(double t, const position& x, std::span<const double> state) const;
  bool is_constant() const { return formula_->is_constant(); }  ///< contains no variable
  bool is_steady() const { return steady_; }                    ///< does not contain t
  bool is_uniform() const { return uniform_; }                  ///< contains no coordinate

 private:
  static constexpr std::size_t most_values = 20;  ///< t, x, y, z and the variables of a law

  using values = std::array<double, most_values>;
  values arguments(double t, const position& x, std::span<const double> further) const;

  std::shared_ptr<const expression> formula_;
  std::size_t space_, further_;  ///< numbers of coordinates, and of velocities or variables
  bool steady_, uniform_ = true;
};

}  // namespace apsis
