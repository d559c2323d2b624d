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

  /// Takes one formula of a flux per variable, in the variables and `constants`. Messages name `key` as the
  /// key of the case. Throws input_error if a formula or a name is invalid, if there are no or too many
  /// variables, or if the number of formulas differs from theirs.
  system_flux(std::vector<std::string> variables, const std::vector<std::string>& formulas,
              const formula_constants& constants = {}, const std::string& key = "model.flux");

  /// Returns n.
  int size() const { return static_cast<int>(variables_.size()); }
  /// Returns the names of the variables.
  const std::vector<std::string>& variables() const { return variables_; }

  /// Evaluates F(u) at `points` states of n numbers each, one after the other. Flux k at point p is F[k
  /// points + p], NaN if the formula has no value.
  void evaluate(const double* u, int points, double* F) const;
  /// Evaluates F(u) like evaluate(), but variable k at point p is u[k points + p].
  void evaluate_columns(const double* u, int points, double* F) const;

  /// Characteristic speeds of a state.
  struct waves {
    double speed = 0.0,   ///< max |λ| over the eigenvalues λ of F'(u); NaN if F is not differentiable at u
        imaginary = 0.0;  ///< max |Im λ|; 0 where the law is hyperbolic, up to rounding
  };
  /// Returns the characteristic speeds at u. F' is a fourth-order difference. Its first steps are a small
  /// part of |u_k| + |F_k(u)|/a, because u_k alone may be a rounding error. `typical` = a > 0 is a speed of
  /// the data.
  waves characteristic_speeds(const double* u,
                              double typical = std::numeric_limits<double>::infinity()) const;
  /// found ← the characteristic speeds of `points` states, where variable k at point p is u[k points + p].
  /// Faster than state by state.
  void characteristic_speeds(const double* u, int points, double typical, waves* found) const;
  /// along ← F'(u) d by a central difference; 0 where it is not finite. `typical` is that
  /// of characteristic_speeds().
  void derivative_along(const double* u, const double* d, double typical, double* along) const;
  /// slopes ← ∂F/∂u_k at u, by differences. The first step is a small part of `size` > 0. Returns true if the
  /// slopes are finite.
  bool differentiate(const double* u, int k, double size, double* slopes) const;

  /// Returns the names and values of the variables for messages: "h = 1, q = 0.5".
  std::string text_of(const double* u) const;

 private:
  struct differences;
  /// sizes ← |u_k| + |F_k(u)|/typical > 0, at least a tenth of the largest.
  void compute_sizes(const double* u, int points, double typical, double* sizes) const;
  void take_first_step(int points, double typical, differences& of) const;
  bool differentiate_all(const double* u, std::span<double> derivative) const;

  std::vector<std::string> variables_;
  std::vector<expression> formulas_;
};

}  // namespace apsis
