#pragma once

#include <apsis/core/errors.hpp>

#include <memory>
#include <string>

namespace apsis {

/// What a formula is written in, and which values it may take.
struct formula_kind {
  std::string variable = "x";  ///< its only free name
  bool nonnegative = true;     ///< evaluate() refuses values below 0
};

/// A formula in one variable for coefficients that a case file gives as text (epsilon(x), a flux F(u);
/// dimensionless). Operators + - * / ^, comparisons and `a ? b : c`; functions sin cos tan asin acos atan
/// sinh cosh tanh exp log (natural) log10 sqrt abs min max; constants pi and e. No assignment.
class expression {
 public:
  static constexpr std::size_t longest = 1000;  ///< characters

  /// `place` is where the first character stands; errors point into the text from there.
  /// Throws input_error: syntax, unknown name, too long, empty.
  explicit expression(const std::string& text, const source_place& place = {}, const formula_kind& kind = {});
  ~expression();
  expression(expression&&) noexcept;             ///< the other can then only be assigned to or destroyed
  expression& operator=(expression&&) noexcept;  ///< likewise

  /// Value at x, whatever it is (NaN outside the domain of a function). Any number of threads at once.
  double value(double x) const;

  /// The same. Throws input_error where the value is not finite, or negative and must not be.
  double evaluate(double x) const;

  const std::string& text() const;  ///< as it was given
  bool is_constant() const;         ///< does not contain the variable

 private:
  struct impl;
  std::unique_ptr<impl> impl_;
};

}  // namespace apsis
