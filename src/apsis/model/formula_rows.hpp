#pragma once

#include <apsis/model/formula_table.hpp>

#include <span>

namespace apsis {

/// Evaluates a formula as a list of operations for the instruction set of this processor. Each operation
/// processes all points before the next one starts. It rounds like the operation on single numbers.
namespace formula_rows {

inline constexpr int most_points = 64,  ///< most points of one call; distance between columns
    most_columns = 32;                  ///< most columns of one call

/// Kind of a step.
enum class operation { add, subtract, multiply, divide, negate, square, cube, fourth_power, call };

/// A column, or a constant if `column` is negative.
struct operand {
  int column = -1;        ///< number of the column
  double constant = 0.0;  ///< the number
};

/// One operation, with a column as its result. An operation on one number takes the first operand.
struct step {
  operation what;                              ///< kind
  operand first,                               ///< first operand
      second;                                  ///< second operand
  int result = 0;                              ///< column of the result; may be that of an operand
  double (*of_one)(double) = nullptr;          ///< function of a call
  double (*of_two)(double, double) = nullptr;  ///< function of a call with two numbers
  const formula_table* table = nullptr;        ///< table of a call with one or two numbers
};

/// Carries out the steps at `points` ≤ most_points points. May overwrite the rest of the last vector
/// behind them.
void evaluate(std::span<const step> steps, int points, double* columns);

}  // namespace formula_rows
}  // namespace apsis
