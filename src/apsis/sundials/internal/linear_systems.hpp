#pragma once

#include "jacobian.hpp"

namespace apsis::sundials {

/// Owns a linear solver of SUNDIALS.
class owned_solver {
 public:
  owned_solver() = default;
  explicit owned_solver(SUNLinearSolver made) : solver_(made) {}
  owned_solver(owned_solver&& other) noexcept : solver_(other.solver_) { other.solver_ = nullptr; }
  owned_solver& operator=(owned_solver&& other) noexcept {
    std::swap(solver_, other.solver_);
    return *this;
  }
  ~owned_solver() {
    if (solver_ != nullptr) SUNLinSolFree(solver_);
  }
  SUNLinearSolver get() const { return solver_; }

 private:
  SUNLinearSolver solver_ = nullptr;
};

/// The systems (I − aJ − b(J² + H)) x = r, Hx = Q''[Q, x], of Newton's method. GMRES, or the iterative solver
/// of the program, solves them. The preconditioner is (I − γJ)⁻¹ with γ = √|b|, applied twice. GMRES of this
/// class applies it from both sides, which keeps more digits. A solver of the program applies it twice from
/// its own side. For b = 0 the preconditioner is (I − aJ)⁻¹, applied once; with a direct solver this is
/// already the solution. For a ≤ 2γ and an eigenvalue z ≤ 0 of γJ,
///   (1 − (a/γ)z + z²)/(1 − z)² = 1 + (2 − a/γ) z/(1 − z)²
/// is between 1/2 and 1, whatever the stiffness. H matters only where a step is as long as the slow times of
/// Q.
class linear_systems {
 public:
  /// Stores a reference; vectors are made like `like`.
  linear_systems(functions& of, const nvector& like);

  jacobian& at() { return jacobian_; }  ///< J

  /// Prepares the preconditioner of a and b. If `fresh`, it uses new data of the Jacobian at the present
  /// state, otherwise those of the last call. Returns 0, or what a callback or a factorization returned.
  int prepare(double a, double b, bool fresh);
  /// Sets whether products contain second derivatives, −b Q''[k, x] with k = Q; `jk` is J k, which must not
  /// change afterwards.
  void set_curvature(bool curved, N_Vector jk) { curved_by_ = curved ? jk : nullptr; }
  /// Whether a direct solver gives the solution, whatever the tolerance.
  bool is_exact() const { return is_direct() && b_ == 0.0; }
  /// x ← the solution for r, with an error of about `tolerance` in the norm with weights w. Returns 0, a
  /// positive number if the solver does not reach it, or a negative one if it failed.
  int solve(N_Vector r, N_Vector x, N_Vector w, double tolerance);
  /// Whether `returned` by solve() is progress: convergence, or a smaller residual without convergence.
  static bool is_progress(int returned);
  /// Throws numerical_error if GMRES has no preconditioner and its matrix multiplied a vector by more than
  /// `most`. Above the default, slow components of the solution are lost in the rounding errors of fast ones.
  void require_solvable(double most = 1e10) const;

 private:
  static int multiply(void* self, N_Vector x, N_Vector z);
  static int precondition(void* self, N_Vector r, N_Vector z, double tolerance, int side);
  int precondition_once(N_Vector r, N_Vector z, double tolerance, int side);
  bool is_direct() const { return of_.matrix != nullptr; }

  functions& of_;
  jacobian jacobian_;
  owned_solver own_;
  SUNLinearSolver iterative_;  ///< own or of the program
  nvector first_, second_, between_;
  N_Vector curved_by_ = nullptr;  ///< J k; NULL for H = 0
  double amplification_ = 0.0;    ///< largest growth of a vector by the matrix, without a preconditioner
  double a_ = 0.0, b_ = 0.0, gamma_ = 0.0;
};

}  // namespace apsis::sundials
