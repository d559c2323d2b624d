#pragma once

#include <apsis/model/system_flux.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// F(u) of a scalar conservation law u_t + F(u)_x = 0. Dimensionless. Thread-safe.
class scalar_flux {
 public:
  /// Returns the predefined names: "linear" is b u, "burgers" u²/2, "buckley-leverett"
  /// u²/(u² + M(1 − u)²) (LeVeque, Finite Volume Methods for Hyperbolic Problems, 2002, section 16.1).
  static const std::vector<std::string>& names();

  /// Takes a predefined name or a formula in u; `slope` is b, `viscosity_ratio` is M. Throws input_error if
  /// the formula is invalid.
  scalar_flux(const std::string& text, double slope, double viscosity_ratio,
              const formula_constants& constants = {});

  /// Returns F(u).
  double operator()(double u) const;
  /// Returns F'(u), exact for predefined names and by fourth-order differences for formulas. The first step
  /// of a difference is a small part of `size` > 0, the largest absolute value of the data. Returns NaN if
  /// there is no finite derivative.
  double derivative(double u, double size = 1.0) const;

  /// A value u and its characteristic speed.
  struct wave {
    double u,   ///< value
        speed;  ///< |F'(u)|; not finite if F is not differentiable at u
  };
  /// Returns the largest |F'| for u in [low, high]: the largest of 2001 values, refined by golden-section
  /// search. If F' is not finite at one of these values, returns the first such value.
  wave fastest(double low, double high) const;

  const std::string& text() const { return text_; }  ///< name or formula, as given

 private:
  enum class kind { linear, burgers, buckley_leverett, formula };

  std::string text_;
  kind kind_;
  double b_, M_;
  std::unique_ptr<system_flux> formula_;  ///< a formula in the single variable u
};

}  // namespace apsis
