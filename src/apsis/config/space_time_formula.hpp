#pragma once

#include <apsis/config/case.hpp>
#include <apsis/model/expression.hpp>
#include <apsis/phase/position.hpp>

#include <cstddef>
#include <memory>
#include <string>

namespace apsis {

/// A formula of a case in the time t, the position and, if it has one, the velocity v_x, v_y, v_z.
/// Dimensionless. Thread-safe.
class space_time_formula {
 public:
  /// `space` and `velocity` are the numbers of dimensions. Throws input_error at `place`: syntax, or an
  /// unknown name.
  space_time_formula(const std::string& text, const source_place& place, const formula_constants& constants,
                     int space, int velocity = 0);

  /// Returns the value. Throws input_error if it is not finite.
  double at(double t, const position& x, const position& v = {}) const;
  bool is_constant() const { return formula_->is_constant(); }  ///< contains no variable
  bool is_steady() const { return steady_; }                    ///< does not contain t

 private:
  std::shared_ptr<const expression> formula_;
  std::size_t space_, velocity_;
  bool steady_;
};

}  // namespace apsis
