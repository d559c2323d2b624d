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

/// Variables and constants of a formula, and a constraint on its values.
struct formula_kind {
  std::vector<std::string> variables = {"x"};  ///< names of its variables, at least one
  bool nonnegative = true;                     ///< whether evaluate() refuses values below 0
  formula_constants constants = {};            ///< constants in addition to pi and e
};

/// Returns the kind of formulas in the coordinates of D = 0 … 3 space dimensions: x for D ≤ 1, then x and y,
/// then x, y and z.
formula_kind formula_of_position(int dimensions, bool nonnegative = true,
                                 const formula_constants& constants = {});

/// Returns why a constant of a formula cannot have this name; "" if it can. A name must be an identifier. It
/// must differ from all functions, constants and variables of formulas.
std::string why_not_a_constant(const std::string& name);

/// Returns why variables of formulas cannot have the names that a user chose; "" if they can. Names must be
/// identifiers and differ from each other. They must also differ from all functions, constants, coordinates
/// and time. The reason names the first offender: "'x' cannot be the name of a variable: it is a coordinate
/// or time".
std::string why_not_variables(const std::vector<std::string>& names, const formula_constants& constants);

/// A conversion of the values v of a formula: to s v, or to 1/(s v) if `inverse`.
struct value_conversion {
  double factor = 1.0;   ///< s
  bool inverse = false;  ///< whether the result is the reciprocal

  /// Returns the converted value.
  double operator()(double v) const { return inverse ? 1.0 / (v * factor) : v * factor; }
  bool operator==(const value_conversion&) const = default;  ///< equal members
};

/// Points at which a formula is evaluated: the value of variable k at point p is
/// variables[k to_next_variable + p to_next_point].
struct formula_points {
  const double* variables;       ///< variables of the first point
  std::size_t to_next_variable,  ///< distance between variables of a point
      to_next_point;             ///< distance between points
};

/// A formula for coefficients that a case file gives as text (ε(x), a flux F(u)); dimensionless. Operators
/// are + - * / ^, comparisons and `a ? b : c`. Functions are sin cos tan asin acos atan sinh cosh tanh exp
/// log (natural) log10 sqrt abs min max, table and table2 (formula_table). Constants are pi and e. There is
/// no assignment.
class expression {
 public:
  /// Returns the number of texts that this process has compiled so far.
  static long compiled_so_far();

  static constexpr std::size_t longest = 1000;  ///< largest number of characters

  /// Compiles `text`, whose first character is at `place`; errors name positions relative to it. Expressions
  /// with equal text, variables and constants share the compiled form. Throws input_error if the text is
  /// empty or too long, violates the syntax, or has an unknown name.
  explicit expression(const std::string& text, const source_place& place = {}, const formula_kind& kind = {});

  /// Returns the value for the given values of the variables, in the order of formula_kind; NaN outside the
  /// domain of a function. Further numbers are ignored. Thread-safe.
  double value(std::span<const double> variables) const;
  /// results ← the values at results.size() points. The variables of a point are contiguous. The results
  /// equal those of value(), which takes longer. Thread-safe.
  void values(std::span<const double> variables, std::span<double> results) const;
  /// results ← the values at results.size() points, with contiguous values of each variable: variable k at
  /// point p is variables[k results.size() + p]. Thread-safe.
  void values_of_columns(std::span<const double> variables, std::span<double> results) const;
  /// Returns the value of a formula in one variable. Thread-safe.
  double value(double x) const { return value({&x, 1}); }

  /// Returns this formula with converted values, with the same text and place. The constraint then applies to
  /// the converted value.
  expression converted(value_conversion by) const;

  /// Returns value(), or throws input_error if it is not finite or violates the constraint of the kind.
  double evaluate(std::span<const double> variables) const;
  /// Returns value(x), with the same check, for a formula in one variable.
  double evaluate(double x) const { return evaluate({&x, 1}); }

  const std::string& text() const;  ///< text as given
  bool is_constant() const;         ///< whether it contains no variable
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
