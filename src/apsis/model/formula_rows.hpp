#pragma once

#include <apsis/model/formula_table.hpp>

#include <span>

namespace apsis {

/// A formula as a list of operations, each on all of some points before the next, for the instruction set of
/// this processor. Every operation rounds like that on two numbers.
namespace formula_rows {

inline constexpr int most_points = 64,  ///< of one evaluation, the distance of columns
    most_columns = 32;                  ///< of one evaluation

/// Kind of a step.
enum class operation { add, subtract, multiply, divide, negate, square, cube, fourth_power, call };

/// A column, or a number where the column is negative.
struct operand {
  int column = -1;        ///< number of the column
  double constant = 0.0;  ///< the number
};

/// One operation, whose result is a column. An operation on one number takes the first operand.
struct step {
  operation what;                              ///< kind
  operand first,                               ///< first operand
      second;                                  ///< second operand
  int result = 0;                              ///< column, which may be that of an operand
  double (*of_one)(double) = nullptr;          ///< function of a call
  double (*of_two)(double, double) = nullptr;  ///< the same, of two numbers
  const formula_table* table = nullptr;        ///< the same, of one or two numbers
};

/// Takes the steps for `points` ≤ most_points points. Numbers behind them may change, up to a whole vector.
void evaluate(std::span<const step> steps, int points, double* columns);

}  // namespace formula_rows
}  // namespace apsis
