#pragma once

#include <apsis/model/expression.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// F(u) of a scalar conservation law u_t + F(u)_x = 0. Dimensionless. Safe to use from several threads.
class scalar_flux {
 public:
  /// Names with a meaning of their own: "linear" is b u, "burgers" u²/2, "buckley-leverett"
  /// u²/(u² + M(1 − u)²) (LeVeque, Finite Volume Methods for Hyperbolic Problems, 2002, section 16.1).
  static const std::vector<std::string>& names();

  /// One of the names, or a formula in u; `slope` is b, `viscosity_ratio` M. Throws input_error.
  scalar_flux(const std::string& text, double slope, double viscosity_ratio);

  /// F(u).
  double operator()(double u) const;
  /// F'(u): exact for the names, by fourth-order differences for a formula.
  double derivative(double u) const;

  /// A value and how fast it moves.
  struct wave {
    double u,   ///< where
        speed;  ///< |F'(u)|, not finite where F has no slope
  };
  /// The largest |F'| for u in [low, high], and where: the best of 2001 values, improved by golden sections.
  /// The first value without a finite slope, if there is one.
  wave fastest(double low, double high) const;

  const std::string& text() const { return text_; }  ///< name or formula, as given

 private:
  enum class kind { linear, burgers, buckley_leverett, formula };

  double slope_of_formula(double u) const;

  std::string text_;
  kind kind_;
  double b_, M_;
  std::unique_ptr<expression> formula_;
};

}  // namespace apsis
