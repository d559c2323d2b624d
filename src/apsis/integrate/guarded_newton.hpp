#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>

namespace apsis {

template <class Real>
class mass_matrix;

/// Coefficients and explicit part of R(v) = v − u_e − a G(v) − b Ġ(v).
template <class Real>
struct stage_terms {
  Real a,                               ///< a ≥ 0
      b;                                ///< b ≤ 0
  std::span<const Real> explicit_part;  ///< u_e
  Real size = Real(0);                  ///< a size of the whole state if v and u_e are parts of it
};

/// Interface of a stage equation R(v) = v − u_e − a G(v) − b Ġ(v) = 0 to Newton's method;
/// n unknowns, dimensionless.
///
/// With a mass matrix M the rate of v is M⁻¹ G(v), and R is multiplied by M: R(v) = M (v − u_e) − a G(v) −
/// b Ġ(v), Ġ(v) = G'(v) M⁻¹ G(v). Sparse M and G' then have sparse stage systems.
template <class Real>
class stage_equation {
 public:
  virtual ~stage_equation() = default;
  virtual stage_terms<Real> terms() const = 0;                       ///< a, b and u_e
  virtual const mass_matrix<Real>* mass() const { return nullptr; }  ///< M; null for the unit matrix
  /// Sets g ← G(v).
  virtual void rate(std::span<const Real> v, std::span<Real> g) = 0;
  /// Sets jk ← G'(v) k, the derivative of G along a flow with the rate k, plus ∂G/∂t if time advances, too.
  virtual void rate_product(std::span<const Real> v, std::span<const Real> k, std::span<Real> jk) = 0;
  /// Sets jx ← G'(v) x and hx ← G''(v)[k, x], the derivative of rate_product in the direction x for a given
  /// k.
  virtual void rate_curvature(std::span<const Real> v, std::span<const Real> k, std::span<const Real> x,
                              std::span<Real> jx, std::span<Real> hx) = 0;
  virtual std::size_t size() const = 0;  ///< n
  /// Sets r ← R(v).
  virtual void residual(std::span<const Real> v, std::span<Real> r) = 0;
  /// Sets the terms of R'(v) x = M x + y + z: y ← −a G'(v) x, z ← −b Ġ'(v) x. They are separate because a
  /// stage is singular where they cancel.
  virtual void differential(std::span<const Real> v, std::span<const Real> x, std::span<Real> y,
                            std::span<Real> z) = 0;
  /// Whether precondition() is available.
  virtual bool has_preconditioner() const { return false; }
  /// Prepares precondition() at v. An earlier one for the same coefficients may serve, unless `again`.
  virtual void prepare_preconditioner(std::span<const Real> v, bool again) {
    (void)v;
    (void)again;
  }
  /// Sets x ← P⁻¹ r for a P that approximates R'.
  virtual void precondition(std::span<const Real> r, std::span<Real> x) {
    std::copy(r.begin(), r.end(), x.begin());
  }
  /// Whether v is admissible; Newton iterates never leave the admissible set once they are inside.
  virtual bool admissible(std::span<const Real> v) = 0;
  /// Returns the size of a correction δ of v in units of the accuracy that is needed. After a correction of
  /// at most 1 the root is accurate enough. The default, +infinity, requires the root to rounding errors.
  virtual Real size_of_correction(std::span<const Real> v, std::span<const Real> delta) {
    (void)v;
    (void)delta;
    return std::numeric_limits<Real>::infinity();
  }
};

/// Linear solver for R'(v) x = −R(v).
enum class linear_solver {
  automatic,  ///< dense up to newton_options::dense_limit unknowns
  dense,      ///< LU of R', assembled from the differential in unit directions
  krylov      ///< matrix-free restarted GMRES on the differential, with the preconditioner of the equation
};

/// Unknowns above which dense systems are reported before a run: LU takes n³ operations in every Newton step.
inline constexpr std::size_t most_unknowns_of_newton = 200;

/// Options of guarded_newton().
struct newton_options {
  linear_solver solver = linear_solver::automatic;  ///< linear solver of every iteration
  std::size_t dense_limit = 96;                     ///< most unknowns for which `automatic` is dense
  int max_iterations = 200;                         ///< iteration limit; exceeding it is an error
  bool warns_of_cost = true;                        ///< newton_problem logs a warning of large dense systems
};

/// Report of guarded_newton().
struct newton_report {
  int iterations = 0;      ///< Newton steps with a matrix of their own, or corrections of simplified_newton
  double residual = 0;     ///< maximum norm of R at the end
  double step = 0;         ///< last Newton step relative to v, maximum norms
  int factorizations = 0;  ///< matrices of the solve, or systems solved without matrices
};

/// Solves R(v) = 0 to round-off, starting from the given v, by Newton's method with exact derivatives.
/// Backtracks on the maximum norm of R until no further improvement is possible. With LU, a step is also
/// accepted if the next step with the same R' is shorter (the natural monotonicity test: Deuflhard, Newton
/// Methods for Nonlinear Problems, section 3.3). If the equation states the accuracy that is needed, the
/// iteration ends with it. In this case corrections with the same R' are repeated while each is at most 1/8
/// of the one before. Instantiated for double and long double.
///
/// Throws numerical_error
/// - if R(v) is not finite at the start;
/// - if R'(v) is singular to working precision: its smallest singular value, relative to the terms of R'
/// before they cancel, is below about 1e-14 in double. For a stage with d = 0, this occurs for Δt λ near
/// ±i/√|ḋ|, λ an eigenvalue of G';
/// - if no step reduces the norm inside the admissible set, if the root is not admissible, or after
/// max_iterations.
template <class Real>
newton_report guarded_newton(stage_equation<Real>& equation, std::span<Real> v,
                             const newton_options& options = {});

}  // namespace apsis
