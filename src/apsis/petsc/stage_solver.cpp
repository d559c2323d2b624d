#include "internal/stage_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <petsc/private/snesimpl.h>
#include <petsc/private/tsimpl.h>
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

PetscErrorCode begin(KSP ksp, Vec rhs, Vec, void* context) {
  return guarded(comm_of(ksp), [&] { static_cast<stage_solver*>(context)->begin_linear_solve(ksp, rhs); });
}

PetscErrorCode finish(KSP ksp, Vec, Vec x, void* context) {
  return guarded(comm_of(ksp), [&] { static_cast<stage_solver*>(context)->finish_linear_solve(ksp, x); });
}

/// γ‖J‖ beyond which stages begin with an implicit Euler step.
constexpr double most_without_start = 3e6;

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
  preconditioner_ = std::make_unique<stage_preconditioner>(ksp, settings_.form);
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
  for (vector* one : {&explicit_part_, &rate_, &product_, &middle_, &moved_, &base_, &right_}) one->reset();
}

bool stage_solver::solve(const stage& now, Vec u) {
  attach(u);
  explicit_part_.assign(u);
  now_ = now;
  jacobian_->evaluate(now.t, u);
  const double gamma = std::max(now.a, std::sqrt(-now.b));
  stiffness_ = gamma * jacobian_->size(u);
  // Far from equilibrium, residuals of (Δt/ε)² Q leave no digits to slow modes, and the equation has other
  // roots than the one that short steps lead to. An implicit Euler step gives a start near equilibrium.
  if (now.b != 0.0 && ((preconditioner_ && stiffness_ > most_without_start) || is_far_from_equilibrium(u))) {
    now_ = {now.t, gamma, 0.0, now.dt, false};
    const bool begun = iterate(u);
    now_ = now;
    if (begun && iterate(u)) return true;
    check(VecCopy(explicit_part_.get(), u));
  }
  return iterate(u);
}

/// Returns whether Q changes an unknown by more than its size in the time √−b of the second derivative. The
/// equations of a solver for linear problems have one root.
bool stage_solver::is_far_from_equilibrium(Vec u) {
  PetscBool linear = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(snes_), SNESKSPONLY, &linear));
  if (linear == PETSC_TRUE) return false;
  const Vec rate = rate_.like(u);
  of_.minus_collision(now_.t, u, rate);
  PetscReal largest = 0.0;
  check(VecMaxPointwiseDivide(rate, u, &largest));
  return std::sqrt(-now_.b) * largest > 1.0;
}

bool stage_solver::iterate(Vec u) {
  last_correction_ = 0.0;
  // During Newton's method the entries of its matrix may change, but not the matrix object.
  linearize(u);
  const Mat p = matrix_ != nullptr ? matrix_ : operator_.get();
  if (p != snes_->jacobian_pre) check(SNESSetJacobian(snes_, operator_.get(), p, form_jacobian, this));
  check(SNESSetUp(snes_));
  KSP ksp = nullptr;
  check(SNESGetKSP(snes_, &ksp));
  check(KSPSetPreSolve(ksp, begin, this));
  check(KSPSetPostSolve(ksp, finish, this));
  check(SNESSolve(snes_, nullptr, u));
  check(SNESGetConvergedReason(snes_, &reason_));
  count_iterations();
  return reason_ > 0;
}

void stage_solver::count_iterations() {
  PetscInt newton = 0, krylov = 0;
  check(SNESGetIterationNumber(snes_, &newton));
  check(SNESGetLinearSolveIterations(snes_, &krylov));
  of_.ts()->snes_its += newton;
  of_.ts()->ksp_its += krylov;
}

void stage_solver::residual(Vec v, Vec r) {
  const Vec rate = rate_.like(v);  // −Q
  of_.minus_collision(now_.t, v, rate);
  check(VecWAXPY(r, -1.0, explicit_part_.get(), v));
  check(VecAXPY(r, now_.a, rate));
  if (now_.b == 0.0) return;
  const Vec product = product_.like(v);
  jacobian_->evaluate(now_.t, v);
  jacobian_->minus_product(rate, product);  // JQ
  check(VecAXPY(r, -now_.b, product));
  if (!now_.timed) return;
  of_.minus_time_derivative(now_.t, now_.dt, v, product);
  check(VecAXPY(r, now_.b, product));
}

void stage_solver::linearize(Vec v) {
  jacobian_->evaluate(now_.t, v);
  if (settings_.curvature && now_.b != 0.0) {
    base_.assign(v);
    of_.minus_collision(now_.t, v, rate_.like(v));
  }
  if (preconditioner_) matrix_ = preconditioner_->prepare(*jacobian_, now_.a, now_.b, stiffness_);
  check(MatAssemblyBegin(operator_.get(), MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(operator_.get(), MAT_FINAL_ASSEMBLY));
}

void stage_solver::product(Vec x, Vec y) {
  if (preconditioner_ && preconditioner_->has_right()) {
    const Vec other = right_.like(x);
    preconditioner_->apply(x, other);
    x = other;
  }
  const Vec middle = middle_.like(x);
  jacobian_->minus_product(x, middle);
  check(VecWAXPY(y, now_.a, middle, x));
  if (now_.b == 0.0) return;
  const Vec product = product_.like(x);
  jacobian_->minus_product(middle, product);
  check(VecAXPY(y, -now_.b, product));
  if (settings_.curvature) add_curvature(x, y);
}

void stage_solver::begin_linear_solve(KSP ksp, Vec rhs) {
  tolerances_.reset();
  if (!preconditioner_ || !preconditioner_->has_right()) return;
  krylov_tolerances own{};
  check(KSPGetTolerances(ksp, &own.relative, &own.absolute, &own.divergence, &own.iterations));
  tolerances_ = own;
  // With one inverse, the norm of a residual is γ‖J‖ times that of a fast correction. Two inverses give the
  // size of the correction.
  PetscReal size = 0.0;
  const Vec once = right_.like(rhs), twice = middle_.like(rhs);
  preconditioner_->apply(rhs, once);
  preconditioner_->apply(once, twice);
  check(VecNorm(twice, NORM_2, &size));
  check(KSPSetTolerances(ksp, 1e-14, std::max(own.absolute, own.relative * size), PETSC_MAX_REAL,
                         own.iterations));
}

void stage_solver::finish_linear_solve(KSP ksp, Vec x) {
  if (!tolerances_) return;
  check(KSPSetTolerances(ksp, tolerances_->relative, tolerances_->absolute, tolerances_->divergence,
                         tolerances_->iterations));
  const Vec other = right_.like(x);
  check(VecCopy(x, other));
  preconditioner_->apply(other, x);
}

/// y ← y − b Q''(v)[Q(v), x], by differences whose errors only slow Newton's method.
void stage_solver::add_curvature(Vec x, Vec y) {
  PetscReal of_v = 0.0, of_x = 0.0, of_rate = 0.0;
  const Vec rate = rate_.get(), moved = moved_.like(x), out = product_.like(x), sum = middle_.like(x);
  check(VecNorm(base_.get(), NORM_2, &of_v));
  check(VecNorm(x, NORM_2, &of_x));
  check(VecNorm(rate, NORM_2, &of_rate));
  if (of_x == 0.0 || of_rate == 0.0) return;
  const double size = 1e-5 * std::max(of_v, 1e-10), along_x = size / of_x, along_rate = size / of_rate;
  check(VecZeroEntries(sum));
  for (const double of_first : {1.0, 0.0}) {
    for (const double of_second : {1.0, 0.0}) {
      check(VecCopy(base_.get(), moved));
      check(VecAXPY(moved, of_first * along_x, x));
      check(VecAXPY(moved, -of_second * along_rate, rate));
      of_.minus_collision(now_.t, moved, out);
      check(VecAXPY(sum, of_first == of_second ? 1.0 : -1.0, out));
    }
  }
  check(VecAXPY(y, now_.b / (along_x * along_rate), sum));
}

SNESConvergedReason stage_solver::test(PetscInt iteration, double of_v, double of_correction,
                                       double of_residual) {
  PetscReal absolute = 0.0, relative = 0.0, step = 0.0;
  check(SNESGetTolerances(snes_, &absolute, &relative, &step, nullptr, nullptr));
  if (!std::isfinite(of_residual)) return SNES_DIVERGED_FNORM_NAN;
  if (of_residual <= absolute) return SNES_CONVERGED_FNORM_ABS;
  if (iteration == 0) return SNES_CONVERGED_ITERATING;
  const double wanted = std::min(relative, step) * of_v, before = last_correction_;
  last_correction_ = of_correction;
  if (of_correction <= wanted) return SNES_CONVERGED_SNORM_RELATIVE;
  if (before == 0.0) return SNES_CONVERGED_ITERATING;
  // Bound the corrections to come by a geometric series. Solutions of linear systems lack the digits that γJ
  // loses. A correction much smaller than the last may therefore be followed by one that is not.
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const double ratio = of_correction / before;
  const double contraction = std::max(ratio, std::min(0.1, std::sqrt(epsilon) * stiffness_));
  if (contraction < 1.0 && contraction / (1.0 - contraction) * of_correction <= wanted)
    return SNES_CONVERGED_SNORM_RELATIVE;
  // Corrections that do not become smaller are rounding errors of Q, multiplied by γJ.
  const bool is_rounding = ratio >= 0.5 && of_correction <= std::min(8.0 * epsilon * stiffness_, 1e-3) * of_v;
  return is_rounding ? SNES_CONVERGED_SNORM_RELATIVE : SNES_CONVERGED_ITERATING;
}

}  // namespace apsis::petsc
