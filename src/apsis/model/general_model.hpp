#pragma once

#include <apsis/model/model.hpp>

#include <boost/math/differentiation/autodiff.hpp>

namespace apsis {

/// A model whose Q(u) has not the structure of a relaxation. Guarded Newton iterations solve the stage
/// equation v = u + a Q(v)/ε + b Q̇(v)/ε², with Q' and Q̇ = Q'Q by automatic differentiation
/// (integrate/newton_problem.hpp). They fail if ε = 0, if 1/ε² overflows, or if the stage is singular.
class general_model : public model {
 public:
  /// A number with its derivatives ∂/∂s, ∂/∂t and ∂²/∂s∂t with respect to two parameters.
  using number = boost::math::differentiation::autodiff_fvar<double, 1, 1>;

  /// q ← Q(u); rows of components() numbers.
  virtual void collision(const number* u, number* q) const = 0;
  int newton_unknowns() const override { return components(); }
  /// Whether a row may be the solution of a stage. Newton iterates stay within these rows.
  virtual bool admissible(const double* u) const = 0;
  std::unique_ptr<point_collision> make_collision(const batch_limits& limits) const final;
};

}  // namespace apsis
