#pragma once

#include <apsis/integrate/guarded_newton.hpp>
#include <apsis/integrate/mass_matrix.hpp>
#include <apsis/integrate/sparsity_pattern.hpp>

#include <memory>
#include <optional>
#include <span>

namespace apsis {

/// A stage equation that also gives its derivative at other times and states.
template <class Real>
class timed_stage_equation : public stage_equation<Real> {
 public:
  /// Sets jx ← ∂G/∂v (t, v) x. Later evaluations of the stage are not affected.
  virtual void product_at(Real t, std::span<const Real> v, std::span<const Real> x, std::span<Real> jx) = 0;
};

/// Simplified Newton method for the stages v = u_e + a G(v) of a step,
///   v ← v + δ,   (M − aJ) δ = −R(v),
/// where M is the mass matrix, or 1, and J is the derivative of G at the beginning of the step. All stages of
/// the step share J, and stages of the same a share the factors of M − aJ. The linear invariants of G are
/// those of J too: every correction conserves them.
///
/// θ = |δ_k|/|δ_{k−1}|, in the units of stage_equation::size_of_correction(), is the measured contraction. A
/// stage is accepted where the estimated remaining error θ/(1 − θ) |δ_k| is at most 1/8 of the accuracy that
/// the equation needs. |δ_k| must also be at most 8 times this accuracy (Hairer & Wanner, Solving Ordinary
/// Differential Equations II, section IV.8). If more corrections are expected than a new matrix costs, J is
/// evaluated at the present v. It then serves this stage and the rest of the step.
///
/// A step depends on its t, Δt and u alone, not on earlier solves: J of an earlier attempt is reused only if
/// that attempt began with the same t and u.
template <class Real>
class simplified_newton {
 public:
  /// With full matrices for no pattern, else with sparse ones that have entries at its places only. The
  /// pattern contains the places of the mass matrix.
  explicit simplified_newton(std::optional<sparsity_pattern> pattern = {},
                             std::optional<mass_matrix<Real>> mass = {});
  simplified_newton(const simplified_newton& other);                 ///< copies pattern and mass matrix
  simplified_newton& operator=(const simplified_newton& other);      ///< copies pattern and mass matrix
  simplified_newton(simplified_newton&& other) noexcept;             ///< moves
  simplified_newton& operator=(simplified_newton&& other) noexcept;  ///< moves
  ~simplified_newton();

  /// States that a step begins with u at the time t.
  void begin_step(Real t, std::span<const Real> u);
  /// States that the step has ended. A stage outside of a step uses J at its explicit part.
  void end_step();

  /// Solves the stage at time t, starting from v. Returns nothing, and leaves v unchanged, if the iteration
  /// does not converge, leaves the admissible set or yields a number that is not finite. guarded_newton() may
  /// then solve the stage. Requires b = 0, and v.size() unknowns in the pattern, if there is one.
  std::optional<newton_report> solve(timed_stage_equation<Real>& equation, Real t, std::span<Real> v);

 private:
  struct parts;
  std::unique_ptr<parts> parts_;
};

}  // namespace apsis
