#pragma once

#include <cstddef>
#include <span>

namespace apsis {

/// A stage equation R(v) = v − u_e − a G(v) − b Ġ(v) = 0 as Newton's method sees it; n numbers,
/// dimensionless.
template <class Real>
class stage_equation {
 public:
  virtual ~stage_equation() = default;
  virtual std::size_t size() const = 0;  ///< n
  /// r ← R(v).
  virtual void residual(std::span<const Real> v, std::span<Real> r) = 0;
  /// The three terms of R'(v) x = x + y + z: y ← −a G'(v) x, z ← −b Ġ'(v) x. They come apart because
  /// cancellation between them is what makes a stage singular.
  virtual void differential(std::span<const Real> v, std::span<const Real> x, std::span<Real> y,
                            std::span<Real> z) = 0;
  /// Newton's iterates never leave the admissible set once they are inside.
  virtual bool admissible(std::span<const Real> v) = 0;
};

/// How R'(v) x = −R(v) is solved.
enum class linear_solver {
  automatic,  ///< dense up to newton_options::dense_limit unknowns
  dense,      ///< LU of R', columns from the differential in unit directions
  krylov      ///< restarted GMRES on the differential, no matrix
};

/// How guarded_newton() works.
struct newton_options {
  linear_solver solver = linear_solver::automatic;  ///< of each iteration
  std::size_t dense_limit = 96;                     ///< most unknowns for which `automatic` is dense
  int max_iterations = 200;                         ///< more is an error
};

/// What guarded_newton() did.
struct newton_report {
  int iterations = 0;   ///< linear systems solved
  double residual = 0;  ///< maximum norm at the end
  double step = 0;      ///< last Newton step relative to v, maximum norms
};

/// Solves R(v) = 0 from the v given, to round-off: Newton's method with exact derivatives and backtracking
/// on the maximum norm of R, until neither improves any further. With LU a step is also taken where it makes
/// the next one, with the same R', shorter (the natural monotonicity test: Deuflhard, Newton Methods for
/// Nonlinear Problems, section 3.3). Instantiated for double and long double.
///
/// Throws numerical_error if R(v) is not finite at the start, if R'(v) is singular to working precision
/// (smallest singular value, relative to the terms of R' before they cancel, below about 1e-14 in double:
/// for a stage with d = 0 that is Δt λ near ±i/√|ḋ|, λ an eigenvalue of G'), if no step reduces the norm
/// inside the admissible set, if the root is not admissible, or after max_iterations.
template <class Real>
newton_report guarded_newton(stage_equation<Real>& equation, std::span<Real> v,
                             const newton_options& options = {});

}  // namespace apsis
