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

  /// `text` is a predefined name or a formula in u; `slope` is b, `viscosity_ratio` M. Throws input_error.
  scalar_flux(const std::string& text, double slope, double viscosity_ratio,
              const formula_constants& constants = {});

  /// Returns F(u).
  double operator()(double u) const;
  /// Returns F'(u): exact for predefined names, by fourth-order differences for formulas, whose first steps
  /// are a small part of the largest value `size` > 0 of the data; NaN if there is no finite derivative.
  double derivative(double u, double size = 1.0) const;

  /// A value u and its characteristic speed.
  struct wave {
    double u,   ///< value
        speed;  ///< |F'(u)|, not finite if F is not differentiable
  };
  /// Returns the largest |F'| for u in [low, high]: the best of 2001 values, refined by golden sections; or
  /// the first value without a finite slope.
  wave fastest(double low, double high) const;

  const std::string& text() const { return text_; }  ///< name or formula, as given

 private:
  enum class kind { linear, burgers, buckley_leverett, formula };

  std::string text_;
  kind kind_;
  double b_, M_;
  std::unique_ptr<system_flux> formula_;  ///< of the single variable u
};

}  // namespace apsis
