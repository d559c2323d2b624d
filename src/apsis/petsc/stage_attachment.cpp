#include "internal/stage_solver.hpp"

#include <petsc/private/snesimpl.h>
#include <petscdm.h>

namespace apsis::petsc {
namespace {

PetscErrorCode form_jacobian(SNES snes, Vec v, Mat, Mat, void* context) {
  return guarded(comm_of(snes), [&] { static_cast<stage_solver*>(context)->linearize(v); });
}

PetscErrorCode apply_operator(Mat of, Vec x, Vec y) {
  return guarded(comm_of(of), [&] {
    void* context = nullptr;
    check(MatShellGetContext(of, static_cast<void*>(&context)));
    static_cast<stage_solver*>(context)->product(x, y);
  });
}

PetscErrorCode test_convergence(SNES snes, PetscInt iteration, PetscReal of_v, PetscReal of_correction,
                                PetscReal of_residual, SNESConvergedReason* reason, void* context) {
  return guarded(comm_of(snes), [&] {
    *reason = static_cast<stage_solver*>(context)->test(iteration, of_v, of_correction, of_residual);
  });
}

mat make_operator(Vec like, stage_solver* context) {
  PetscInt local = 0, global = 0;
  check(VecGetLocalSize(like, &local));
  check(VecGetSize(like, &global));
  mat made;
  check(MatCreateShell(comm_of(like), local, local, global, global, context, made.receive()));
  const auto function = reinterpret_cast<void (*)()>(apply_operator);
  check(MatShellSetOperation(made.get(), MATOP_MULT, function));
  return made;
}

/// Removes a preconditioner that needs a matrix, as PETSc does for matrix-free operators. Preconditioners
/// that the program defines remain.
void use_no_preconditioner(KSP ksp) {
  PC pc = nullptr;
  PetscBool own = PETSC_FALSE;
  check(KSPGetPC(ksp, &pc));
  check(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(pc), &own, PCSHELL, PCKSP, PCMAT, ""));
  if (own == PETSC_FALSE) check(PCSetType(pc, PCNONE));
}

}  // namespace

void stage_solver::attach(Vec like) {
  SNES snes = nullptr;
  check(TSGetSNES(of_.ts(), &snes));
  Mat a = nullptr;
  check(SNESGetJacobian(snes, &a, nullptr, nullptr, nullptr));
  if (snes_ == snes && operator_ && a == operator_.get()) {
    if (!preconditioner_ || preconditioner_->in_place()) return;
  }
  detach();
  owner_ = nonlinear_solver::share(snes);
  snes_ = snes;
  const jacobian_choice chosen = choose_jacobian(of_, snes);
  Mat own_a = nullptr, own_p = nullptr;
  PetscBool p_only = PETSC_FALSE, matrix_free = PETSC_FALSE;
  DM dm = nullptr;
  check(SNESGetDM(snes, &dm));
  check(DMSNESGetJacobian(dm, &own_jacobian_, &own_context_));
  check(SNESGetJacobian(snes, &own_a, &own_p, nullptr, nullptr));
  check(SNESGetUseMatrixFree(snes, &p_only, &matrix_free));
  own_a_ = mat::share(own_a);
  own_p_ = mat::share(own_p);
  own_p_only_ = p_only == PETSC_TRUE;
  own_matrix_free_ = matrix_free == PETSC_TRUE;
  jacobian_.emplace(of_, chosen, settings_.constant_jacobian || of_.has_constant_jacobian());
  operator_ = make_operator(like, this);
  check(SNESSetUseMatrixFree(snes, PETSC_FALSE, PETSC_FALSE));
  // Until the first stage is linearized, the operator also serves as a matrix of the right size.
  check(SNESSetJacobian(snes, operator_.get(), operator_.get(), form_jacobian, this));
  own_test_ = snes->ops->converged == SNESConvergedDefault;
  if (own_test_) check(SNESSetConvergenceTest(snes, test_convergence, this, nullptr));
  KSP ksp = nullptr;
  check(SNESGetKSP(snes, &ksp));
  if (jacobian_->entries() == nullptr) return use_no_preconditioner(ksp);
  preconditioner_ = std::make_unique<stage_preconditioner>(ksp, settings_.form, set_ups_);
}

void stage_solver::detach() {
  if (snes_ == nullptr) return;
  preconditioner_.reset();
  matrix_ = nullptr;
  // Destructors cannot report errors; PETSc has printed them. The next solve sets up its matrices again.
  snes_->setupcalled = PETSC_FALSE;
  if (snes_->ksp != nullptr) {
    static_cast<void>(KSPSetPreSolve(snes_->ksp, nullptr, nullptr));
    static_cast<void>(KSPSetPostSolve(snes_->ksp, nullptr, nullptr));
  }
  const auto flag = [](bool on) { return on ? PETSC_TRUE : PETSC_FALSE; };
  static_cast<void>(SNESSetUseMatrixFree(snes_, flag(own_p_only_), flag(own_matrix_free_)));
  if (snes_->jacobian == operator_.get()) {
    static_cast<void>(MatDestroy(&snes_->jacobian));
    static_cast<void>(MatDestroy(&snes_->jacobian_pre));
    DM dm = nullptr;
    static_cast<void>(SNESGetDM(snes_, &dm));
    static_cast<void>(SNESSetJacobian(snes_, own_a_.get(), own_p_.get(), nullptr, nullptr));
    static_cast<void>(DMSNESSetJacobian(dm, own_jacobian_, own_context_));
  }
  if (own_test_) static_cast<void>(SNESSetConvergenceTest(snes_, SNESConvergedDefault, nullptr, nullptr));
  jacobian_.reset();
  operator_.reset();
  own_a_.reset();
  own_p_.reset();
  snes_ = nullptr;
  owner_.reset();
}

void stage_solver::reset() {
  detach();
  for (vector* one : {&explicit_part_, &start_, &rate_, &product_, &middle_, &moved_, &base_, &right_})
    one->reset();
}

}  // namespace apsis::petsc
