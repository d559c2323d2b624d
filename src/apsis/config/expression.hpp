#pragma once

#include <apsis/core/errors.hpp>

#include <memory>
#include <string>

namespace apsis {

/// A formula in one variable x, for coefficients that a case file gives as text (epsilon(x); dimensionless).
/// Operators + - * / ^, comparisons and `a ? b : c`; functions sin cos tan asin acos atan sinh cosh tanh exp
/// log (natural) log10 sqrt abs min max; constants pi and e. No assignment.
class expression {
 public:
  static constexpr std::size_t longest = 1000;  ///< characters

  /// `place` is where the first character stands; errors point into the text from there.
  /// Throws input_error: syntax, unknown name, too long, empty.
  explicit expression(std::string text, source_place place = {});
  ~expression();
  expression(expression&&) noexcept;
  expression& operator=(expression&&) noexcept;

  /// Value at x; not for several threads at once.
  /// Throws input_error where the value is not finite or is negative.
  double evaluate(double x) const;

  const std::string& text() const;
  bool depends_on_x() const;

 private:
  struct impl;
  std::unique_ptr<impl> impl_;
};

}  // namespace apsis
