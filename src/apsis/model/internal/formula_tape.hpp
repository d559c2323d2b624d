#pragma once

#include <apsis/model/expression.hpp>
#include <apsis/model/formula_rows.hpp>
#include <apsis/model/formula_table.hpp>

#include <optional>
#include <span>
#include <vector>

namespace apsis {

/// The operations of a formula in the order in which a parser takes them, for many points at a time.
/// Thread-safe.
class formula_tape {
 public:
  /// Returns that of a formula which muParser reads; none if it has a condition, or more variables and
  /// intermediate results than columns. The tables must outlive it.
  static std::optional<formula_tape> of(const text_of_tables& text, const formula_kind& kind);

  /// Evaluates the formula at results.size() points.
  void evaluate(const formula_points& at, std::span<double> results) const;

 private:
  formula_tape() = default;

  std::vector<formula_rows::step> steps_;
  std::vector<int> used_;         ///< variables of the first columns
  formula_rows::operand result_;  ///< of the formula
};

}  // namespace apsis
