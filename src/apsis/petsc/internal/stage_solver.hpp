#pragma once

#include "collision_jacobian.hpp"
#include "split_functions.hpp"
#include "stage_preconditioner.hpp"

#include <memory>
#include <optional>

namespace apsis::petsc {

/// Settings of stage solves.
struct stage_settings {
  preconditioner_form form = preconditioner_form::automatic;
  bool curvature = false;          ///< whether Newton's matrix contains the derivative of J along Q
  bool constant_jacobian = false;  ///< whether the program states that ∂Q/∂u is constant
};

/// A stage v = u_e + a Q(t, v) + b (J Q)(t, v) with J = ∂Q/∂u; if `timed`, also + b ∂Q/∂t.
struct stage {
  double t = 0.0, a = 0.0, b = 0.0;
  double dt = 0.0;     ///< length of the step, for differences in time
  bool timed = false;  ///< whether the stage contains ∂Q/∂t
};

/// Tolerances of a KSP.
struct krylov_tolerances {
  PetscReal relative, absolute, divergence;
  PetscInt iterations;
};

/// Solves stages by the SNES of a TS. Until detach(), this solver provides the function, matrices,
/// convergence test and preconditioner of the SNES.
///
/// Newton's method ends when its correction is small, measured against -snes_stol and -snes_rtol. Residuals
/// are unsuitable: they contain (Δt/ε)² Q, whose rounding errors exceed every useful tolerance.
class stage_solver {
 public:
  /// Stores a reference.
  stage_solver(split_functions& of, const stage_settings& settings) : of_(of), settings_(settings) {}
  ~stage_solver() { detach(); }
  stage_solver(const stage_solver&) = delete;
  stage_solver& operator=(const stage_solver&) = delete;

  /// u ← v. Returns whether Newton's method converged; if not, u is undefined.
  bool solve(const stage& now, Vec u);
  /// Returns why the last solve ended.
  SNESConvergedReason reason() const { return reason_; }

  /// Returns how often preconditioners were set up since reset_counter().
  long set_ups() const { return set_ups_; }
  void reset_counter() { set_ups_ = 0; }

  /// r ← v − u_e − aQ − bJQ, as the function of the SNES.
  void residual(Vec v, Vec r);
  /// Evaluates the matrices at v, as the function of the SNES for its Jacobian.
  void linearize(Vec v);
  /// y ← (1 − aJ − bJ²) x, or with (1 − γJ)⁻¹ x instead of x (stage_preconditioner).
  void product(Vec x, Vec y);
  /// Sets the tolerance of a linear solve to that of the correction; called by the KSP.
  void begin_linear_solve(KSP ksp, Vec rhs);
  /// x ← (1 − γJ)⁻¹ x if product() contains this inverse; called by the KSP.
  void finish_linear_solve(KSP ksp, Vec x);
  /// The convergence test of the SNES.
  SNESConvergedReason test(PetscInt iteration, double of_v, double of_correction, double of_residual);
  /// Restores the parts that the SNES had before.
  void detach();
  /// Detaches, and releases the work vectors.
  void reset();

 private:
  void attach(Vec like);
  bool is_linear() const;
  bool is_far_from_equilibrium(Vec u);
  bool iterate(Vec u);
  bool try_iterate(Vec u);
  void linearize(Vec v, renewal which);
  void add_curvature(Vec x, Vec y);
  void count_iterations();

  split_functions& of_;
  const stage_settings& settings_;
  nonlinear_solver owner_;  ///< of snes_
  SNES snes_ = nullptr;
  mat own_a_, own_p_, operator_;
  bool own_p_only_ = false, own_matrix_free_ = false, own_test_ = false;
  PetscErrorCode (*own_jacobian_)(SNES, Vec, Mat, Mat, void*) = nullptr;
  void* own_context_ = nullptr;
  std::optional<collision_jacobian> jacobian_;
  std::unique_ptr<stage_preconditioner> preconditioner_;
  Mat matrix_ = nullptr;  ///< owned by preconditioner_
  renewal renewal_ = renewal::distant;
  bool snes_lags_ = false;  ///< whether the program chose when SNES computes matrices and preconditioners
  bool has_kept_ = false;   ///< whether the present iteration used a matrix of an earlier J
  long set_ups_ = 0;
  stage now_;
  vector explicit_part_, start_, rate_, product_, middle_, moved_, base_, right_;
  std::optional<krylov_tolerances> tolerances_;  ///< of the program, during a linear solve with two inverses
  SNESConvergedReason reason_ = SNES_CONVERGED_ITERATING;
  double last_correction_ = 0.0, stiffness_ = 0.0;  ///< stiffness_: γ‖J‖
};

}  // namespace apsis::petsc
