#pragma once

#include "collision_jacobian.hpp"
#include "handle.hpp"

#include <vector>

#include <petscsnes.h>

namespace apsis::petsc {

/// Preconditioners of 1 − aJ − bJ².
enum class preconditioner_form {
  automatic,  ///< `squared` if the Krylov method iterates, or if rounding of J² would swamp the identity
  squared,    ///< (1 − γJ)⁻¹ twice, γ = √|b|, by the preconditioner of the program for 1 − γJ
  assembled   ///< the preconditioner of the program for the assembled matrix 1 − aJ − bJ²
};

/// Which matrices of an earlier J are computed anew.
enum class renewal {
  distant,  ///< those that differ much from the present one, or slow an iteration
  changed,  ///< those that differ from the present one by more than rounding
  all,
  none  ///< only those of other coefficients
};

/// Returns whether the program chose when a SNES computes matrices and preconditioners: by the options
/// -snes_lag_jacobian and -snes_lag_preconditioner, or by functions.
bool has_lag(SNES snes);

/// The preconditioner of a stage.
///
/// With γ = √|b| and a ≤ 2γ, the quotient (1 − az + |b|z²)/(1 − γz)² is in [1/2, 1] for real z ≤ 0, so that
/// the number of iterations is bounded uniformly in Δt/ε. The squared form needs no J². Rounding preserves
/// the identity in 1 − γJ up to Δt/ε = 1e16, but in the assembled matrix only up to 1e8. One inverse stands
/// on each side of the operator. Both on one side would multiply rounding errors by (Δt/ε)² instead of Δt/ε.
/// If b = 0, γ is a, and the inverse is applied once.
///
/// Each γ of a step has its matrix M and a preconditioner. The next steps of this length use them again while
/// ‖M(J) − M‖ ≤ 0.03 in the maximum norm, or 0.01 for KSPPREONLY. If ‖M⁻¹‖ ≤ 1, the preconditioned matrix
/// then changes by as little. An iteration that fails or becomes slow renews them, too. Where J is constant,
/// they are kept for steps of all lengths. A preconditioner that only the program can make, such as PCSHELL,
/// is set up again for each γ.
class stage_preconditioner {
 public:
  /// Replaces the preconditioner of `ksp` by this one, which applies the former to its matrices. Adds the
  /// number of its set-ups to `set_ups`.
  stage_preconditioner(KSP ksp, preconditioner_form form, long& set_ups);
  ~stage_preconditioner();
  stage_preconditioner(const stage_preconditioner&) = delete;
  stage_preconditioner& operator=(const stage_preconditioner&) = delete;

  /// Returns whether the KSP still has the preconditioner that the constructor gave it.
  bool in_place() const;
  /// Releases the matrices of other step lengths than dt, unless J is constant.
  void begin_stage(const collision_jacobian& j, double dt);
  /// Prepares the matrix for a stage (a, b) at the present J, and returns it for the KSP. `stiffness` is
  /// about γ‖J‖.
  Mat prepare(const collision_jacobian& j, double a, double b, double stiffness, renewal which);
  /// Whether the present matrix is that of an earlier J.
  bool is_kept() const { return now_ != nullptr && now_->kept; }
  /// Renews the present matrix when it is prepared for the next time, if it is kept.
  void renew_next() {
    if (now_ != nullptr) now_->slow = now_->kept;
  }
  /// Takes note of the iterations of a linear solve. Calls renew_next() if they have become many.
  void finish_solve(PetscInt iterations);
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
    long version = -1;                 ///< collision_jacobian::version() for which it was prepared; −1: none
    bool kept = false, slow = false;   ///< whether it is of an earlier J, and too slow
    PetscObjectState set_up_for = -1;  ///< state of the matrix when `pc` was set up
    PetscInt iterations = 0;           ///< of the last solve with its own J
  };
  struct callbacks;

  bool has_copies() const;
  entry& find(double a, double b, bool squared);
  void renew(entry& one, const collision_jacobian& j);
  bool keep(entry& one, const collision_jacobian& j, double most);
  void assemble(mat& to, double a, double b, Mat minus_j);
  void assemble_polynomial(mat& to, double a, double b, Mat minus_j);
  void copy_pc(entry& to);
  void set_up();

  KSP ksp_;
  preconditioner_form form_;
  long& set_ups_;
  bool direct_ = false, twice_ = false;  ///< direct_: KSPPREONLY
  preconditioner own_, shell_;
  std::vector<entry> entries_;
  entry* now_ = nullptr;
  double dt_ = 0.0;                    ///< step length of the entries
  mat square_, shifted_, polynomial_;  ///< J², and work matrices of both forms
};

}  // namespace apsis::petsc
