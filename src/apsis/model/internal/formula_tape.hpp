#pragma once

#include <apsis/model/expression.hpp>
#include <apsis/model/formula_rows.hpp>
#include <apsis/model/formula_table.hpp>

#include <optional>
#include <span>
#include <vector>

namespace apsis {

/// The operations of a formula in the order of the parser, for many points at a time. Thread-safe.
class formula_tape {
 public:
  /// Returns the tape of a formula that muParser can parse. Returns nothing if the formula has a condition,
  /// or more variables and intermediate results than columns. The tables must outlive the tape.
  static std::optional<formula_tape> of(const text_of_tables& text, const formula_kind& kind);

  /// Evaluates the formula at results.size() points.
  void evaluate(const formula_points& at, std::span<double> results) const;

 private:
  formula_tape() = default;

  std::vector<formula_rows::step> steps_;
  std::vector<int> used_;         ///< numbers of the variables in the first columns
  formula_rows::operand result_;  ///< result of the formula
};

}  // namespace apsis
