#pragma once

#include <apsis/integrate/guarded_newton.hpp>
#include <apsis/integrate/mass_matrix.hpp>
#include <apsis/integrate/sparsity_pattern.hpp>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

namespace apsis {

/// Solves the stage equation for v and its rate k = G(v) together,
///   M (v − u_e − a k) − b G'(v) k = 0,   M k − G(v) = 0,
/// where M is the mass matrix, or 1: a system of 2n unknowns that contains neither the square of G' nor G'(v)
/// G(v), whose rounding errors are those of G times (Δt λ)². An error of the size of rounding in G thus moves
/// v by ε_mach Δt λ, not ε_mach (Δt λ)².
///
/// Newton's method with exact derivatives, LU and the natural monotonicity test (Deuflhard, Newton Methods
/// for Nonlinear Problems, section 3.3). Corrections are measured in units of their own rounding errors,
/// |S⁻¹| ε_mach Σ|terms| (S: internal/stage_system.hpp), so that no choice of units or scales enters; the
/// iteration ends when every unknown is accurate to a few of these.
///
/// Throws numerical_error like guarded_newton(), and if rounding errors move v by more than 1e-3 of the
/// largest of v, u_e and stage_terms::size: then the stage is singular to working precision.
template <class Real>
newton_report unsquared_newton(stage_equation<Real>& equation, std::span<Real> v,
                               const newton_options& options);

/// The same for a G' with a sparsity pattern: S is assembled from one product for each group of columns and
/// factorized as a sparse matrix, with the order of elimination of the first stage. Rounding errors of the
/// unknowns are estimated from a few random ones instead of |S⁻¹|.
template <class Real>
class sparse_newton {
 public:
  /// Stores the pattern of G', which contains the places of the mass matrix, and this matrix.
  explicit sparse_newton(const sparsity_pattern& pattern, std::optional<mass_matrix<Real>> mass = {});
  sparse_newton(const sparse_newton& other);                 ///< copies pattern and mass matrix
  sparse_newton& operator=(const sparse_newton& other);      ///< copies pattern and mass matrix
  sparse_newton(sparse_newton&& other) noexcept;             ///< moves
  sparse_newton& operator=(sparse_newton&& other) noexcept;  ///< moves
  ~sparse_newton();

  /// Whether n is the number of unknowns of the pattern.
  bool fits(std::size_t n) const;
  /// Solves a stage like unsquared_newton(); throws input_error if v has another number of unknowns than the
  /// pattern.
  newton_report solve(stage_equation<Real>& equation, std::span<Real> v, const newton_options& options);

 private:
  struct parts;
  std::unique_ptr<parts> parts_;
};

}  // namespace apsis
