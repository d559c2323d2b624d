#pragma once

#include <apsis/core/errors.hpp>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// What a formula is written in, and which values it may take.
struct formula_kind {
  std::vector<std::string> variables = {"x"};  ///< its free names, at least one
  bool nonnegative = true;                     ///< evaluate() refuses values below 0
};

/// Formulas in the coordinates of D = 0 … 3 space dimensions: x; x and y; x, y and z (x for D = 0).
formula_kind formula_of_position(int dimensions, bool nonnegative = true);

/// A formula for coefficients that a case file gives as text (ε(x), a flux F(u)); dimensionless. Operators
/// + - * / ^, comparisons and `a ? b : c`; functions sin cos tan asin acos atan sinh cosh tanh exp log
/// (natural) log10 sqrt abs min max; constants pi and e. No assignment.
class expression {
 public:
  static constexpr std::size_t longest = 1000;  ///< characters

  /// `place` is where the first character stands; errors point into the text from there.
  /// Throws input_error: syntax, unknown name, too long, empty.
  explicit expression(const std::string& text, const source_place& place = {}, const formula_kind& kind = {});
  ~expression();
  expression(expression&&) noexcept;             ///< the source can then only be assigned to or destroyed
  expression& operator=(expression&&) noexcept;  ///< the source can then only be assigned to or destroyed

  /// The value where the variables have these values, in the order of formula_kind; further numbers are not
  /// used. NaN outside the domain of a function. Thread-safe.
  double value(std::span<const double> variables) const;
  /// The value of a formula in one variable. Thread-safe.
  double value(double x) const { return value({&x, 1}); }

  /// Like value(), but throws input_error where the result is not finite, or negative and must not be.
  double evaluate(std::span<const double> variables) const;
  /// The same for a formula in one variable.
  double evaluate(double x) const { return evaluate({&x, 1}); }

  const std::string& text() const;  ///< as it was given
  bool is_constant() const;         ///< contains no variable

 private:
  struct impl;
  std::unique_ptr<impl> impl_;
};

}  // namespace apsis
