#pragma once

#include <apsis/core/errors.hpp>

#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// Values of constants of the user by name, such as the table [parameters] of a case file.
using formula_constants = std::map<std::string, double>;

/// Names of a formula and constraint on its values.
struct formula_kind {
  std::vector<std::string> variables = {"x"};  ///< its free names, at least one
  bool nonnegative = true;                     ///< evaluate() refuses values below 0
  formula_constants constants = {};            ///< in addition to pi and e
};

/// Returns the kind of formulas in the coordinates of D = 0 … 3 space dimensions: x; x and y; x, y and z (x
/// for D = 0).
formula_kind formula_of_position(int dimensions, bool nonnegative = true,
                                 const formula_constants& constants = {});

/// Returns why a constant of a formula cannot have this name, "" if it can: it is not an identifier, or the
/// name of a function, of a constant, or of a variable of some kind of formula.
std::string why_not_a_constant(const std::string& name);

/// Returns why variables of formulas cannot have these names, chosen by a user, "" if they can: the first one
/// that is not an identifier, is the name of a function, of a constant, of a coordinate or of time, or occurs
/// twice: "'x' is a coordinate or time".
std::string why_not_variables(const std::vector<std::string>& names, const formula_constants& constants);

/// A conversion of the values of a formula: s v, or 1/(s v) if it is inverse.
struct value_conversion {
  double factor = 1.0;   ///< s
  bool inverse = false;  ///< whether the result is the reciprocal

  /// Returns the converted value.
  double operator()(double v) const { return inverse ? 1.0 / (v * factor) : v * factor; }
  bool operator==(const value_conversion&) const = default;  ///< the same factor and kind
};

/// Points at which a formula is evaluated: the value of variable k at point p is
/// variables[k to_next_variable + p to_next_point].
struct formula_points {
  const double* variables;       ///< of the first point
  std::size_t to_next_variable,  ///< distance of variables
      to_next_point;             ///< distance of points
};

/// A formula for coefficients that a case file gives as text (ε(x), a flux F(u)); dimensionless. Operators
/// + - * / ^, comparisons and `a ? b : c`; functions sin cos tan asin acos atan sinh cosh tanh exp log
/// (natural) log10 sqrt abs min max, table and table2 (formula_table); constants pi and e. No assignment.
class expression {
 public:
  /// Returns the number of texts compiled by this process so far.
  static long compiled_so_far();

  static constexpr std::size_t longest = 1000;  ///< characters

  /// `place` is the place of the first character; errors point into the text from there.
  /// Throws input_error: syntax, unknown name, too long, empty.
  /// Expressions of one text with the same variables and constants are compiled once.
  explicit expression(const std::string& text, const source_place& place = {}, const formula_kind& kind = {});

  /// Returns the value for the given values of the variables, in the order of formula_kind; further numbers
  /// are ignored. NaN outside the domain of a function. Thread-safe.
  double value(std::span<const double> variables) const;
  /// results ← the values at results.size() points, whose variables follow each other. Thread-safe; faster
  /// than calls of value(), whose results they equal.
  void values(std::span<const double> variables, std::span<double> results) const;
  /// The same where all values of a variable follow each other: that of variable k at point p is
  /// variables[k results.size() + p].
  void values_of_columns(std::span<const double> variables, std::span<double> results) const;
  /// Returns the value of a formula in one variable. Thread-safe.
  double value(double x) const { return value({&x, 1}); }

  /// Returns this formula with converted values. Text, place and constraint stay; the constraint is that of
  /// the converted value.
  expression converted(value_conversion by) const;

  /// Returns value(), or throws input_error if it is not finite or violates the constraint of the kind.
  double evaluate(std::span<const double> variables) const;
  /// The same check for a formula in one variable.
  double evaluate(double x) const { return evaluate({&x, 1}); }

  const std::string& text() const;  ///< text as given
  bool is_constant() const;         ///< contains no variable
  /// Whether the formula contains a variable of its kind.
  bool uses(const std::string& variable) const;

 private:
  struct compiled;
  void evaluate_at(const formula_points& at, std::span<double> results) const;

  std::shared_ptr<const compiled> compiled_;
  source_place place_;
  std::vector<std::string> variables_;
  bool nonnegative_ = true;
  value_conversion conversion_{};
};

}  // namespace apsis
