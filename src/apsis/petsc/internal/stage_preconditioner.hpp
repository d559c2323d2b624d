#pragma once

#include "collision_jacobian.hpp"
#include "handle.hpp"

#include <vector>

namespace apsis::petsc {

/// Preconditioners of 1 − aJ − bJ².
enum class preconditioner_form {
  automatic,  ///< `squared` if the Krylov method iterates, or if rounding of J² would swamp the identity
  squared,    ///< (1 − γJ)⁻¹ twice, γ = √|b|, by the preconditioner of the program for 1 − γJ
  assembled   ///< the preconditioner of the program for the assembled matrix 1 − aJ − bJ²
};

/// The preconditioner of a stage.
///
/// With γ = √|b| and a ≤ 2γ, the quotient (1 − az + |b|z²)/(1 − γz)² is in [1/2, 1] for real z ≤ 0, so that
/// the number of iterations is bounded uniformly in Δt/ε. The squared form needs no J². Rounding preserves
/// the identity in 1 − γJ up to Δt/ε = 1e16, but in the assembled matrix only up to 1e8. One inverse stands
/// on each side of the operator. Both on one side would multiply rounding errors by (Δt/ε)² instead of Δt/ε.
/// If b = 0, γ is a, and the inverse is applied once.
///
/// Where J is constant, matrices and their preconditioners are kept for every γ.
class stage_preconditioner {
 public:
  /// Replaces the preconditioner of `ksp` by this one, which applies the former to its matrices.
  stage_preconditioner(KSP ksp, preconditioner_form form);
  ~stage_preconditioner();
  stage_preconditioner(const stage_preconditioner&) = delete;
  stage_preconditioner& operator=(const stage_preconditioner&) = delete;

  /// Returns whether the KSP still has the preconditioner that the constructor gave it.
  bool in_place() const;
  /// Prepares the matrix for a stage (a, b) at the present J, and returns it for the KSP. `stiffness` is
  /// about γ‖J‖.
  Mat prepare(const collision_jacobian& j, double a, double b, double stiffness);
  /// Whether the inverse belongs on both sides of the operator.
  bool has_right() const { return twice_; }
  /// y ← (1 − γJ)⁻¹ x, approximately; without has_right(), the inverse of the assembled matrix.
  void apply(Vec x, Vec y);

 private:
  /// A matrix 1 − aJ − bJ² with its preconditioner; for the squared form a is γ, and b is 0.
  struct entry {
    double a = 0.0, b = 0.0;
    mat matrix{};
    preconditioner pc{};
    long version = -1;        ///< collision_jacobian::version() of the matrix
    bool has_square = false;  ///< whether its pattern contains that of J²
  };
  struct callbacks;

  entry& find(const collision_jacobian& j, double a, double b, bool squared);
  void assemble_shifted(entry& to, Mat minus_j);
  void assemble_polynomial(entry& to, Mat minus_j);
  void copy_pc(entry& to);
  /// Keeps the present preconditioner if -snes_lag_preconditioner does. SNES decides this after prepare().
  void follow_reuse() const;

  KSP ksp_;
  preconditioner_form form_;
  bool direct_ = false, twice_ = false;  ///< direct_: KSPPREONLY
  preconditioner own_, shell_;
  std::vector<entry> entries_;
  entry* now_ = nullptr;
  mat square_;
};

}  // namespace apsis::petsc
