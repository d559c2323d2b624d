#pragma once

#include <apsis/model/expression.hpp>

#include <limits>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// F(u) of a system of conservation laws u_t + F(u)_x = 0 in n variables, one formula for each.
/// Dimensionless. Thread-safe.
class system_flux {
 public:
  /// Largest number of variables.
  static constexpr int most_variables = 16;

  /// Formulas of the fluxes in the variables and `constants`, and the key of a case that messages name.
  /// Throws input_error: a formula that cannot be read, more or fewer formulas than variables, or no or too
  /// many variables.
  system_flux(std::vector<std::string> variables, const std::vector<std::string>& formulas,
              const formula_constants& constants = {}, const std::string& key = "model.flux");

  /// Returns n.
  int size() const { return static_cast<int>(variables_.size()); }
  /// Returns the names of the variables.
  const std::vector<std::string>& variables() const { return variables_; }

  /// F(u) at `points` states of n numbers each, one after the other: flux k at point p is F[k points + p],
  /// NaN where the formula has no value.
  void evaluate(const double* u, int points, double* F) const;
  /// The same where variable k at point p is u[k points + p].
  void evaluate_columns(const double* u, int points, double* F) const;

  /// Characteristic speeds of a state.
  struct waves {
    double speed = 0.0,   ///< max |λ| over the eigenvalues λ of F'(u); NaN if F is not differentiable at u
        imaginary = 0.0;  ///< max |Im λ|; 0 where the law is hyperbolic, up to rounding
  };
  /// Returns the characteristic speeds at u. F' is a fourth-order difference, whose first steps are a small
  /// part of |u_k| + |F_k(u)|/a with a speed `typical` = a > 0 of the data: u_k alone may be rounding.
  waves characteristic_speeds(const double* u,
                              double typical = std::numeric_limits<double>::infinity()) const;
  /// The same of `points` states, variable k at point p being u[k points + p]; faster than one by one.
  void characteristic_speeds(const double* u, int points, double typical, waves* found) const;
  /// along ← F'(u) d by a central difference, 0 where it is not finite; `typical` as above.
  void derivative_along(const double* u, const double* d, double typical, double* along) const;
  /// slopes ← ∂F/∂u_k at u; the first step is a small part of `size` > 0. Returns whether they are finite.
  bool differentiate(const double* u, int k, double size, double* slopes) const;

  /// Returns "h = 1, q = 0.5" for messages.
  std::string text_of(const double* u) const;

 private:
  struct differences;
  /// |u_k| + |F_k(u)|/typical, at least a tenth of the largest; positive.
  void compute_sizes(const double* u, int points, double typical, double* sizes) const;
  void take_first_step(int points, double typical, differences& of) const;
  bool differentiate_all(const double* u, std::span<double> derivative) const;

  std::vector<std::string> variables_;
  std::vector<expression> formulas_;
};

}  // namespace apsis
