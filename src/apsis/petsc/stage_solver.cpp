#include "internal/stage_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <petsc/private/snesimpl.h>
#include <petsc/private/tsimpl.h>

namespace apsis::petsc {
namespace {

PetscErrorCode begin(KSP ksp, Vec rhs, Vec, void* context) {
  return guarded(comm_of(ksp), [&] { static_cast<stage_solver*>(context)->begin_linear_solve(ksp, rhs); });
}

PetscErrorCode finish(KSP ksp, Vec, Vec x, void* context) {
  return guarded(comm_of(ksp), [&] { static_cast<stage_solver*>(context)->finish_linear_solve(ksp, x); });
}

/// Ratio of two corrections beyond which matrices of an earlier J are renewed.
constexpr double slow = 0.3;

/// γ‖J‖ beyond which stages begin with an implicit Euler step.
constexpr double most_without_start = 3e6;

}  // namespace

bool stage_solver::solve(const stage& now, Vec u) {
  attach(u);
  explicit_part_.assign(u);
  now_ = now;
  jacobian_->evaluate(now.t, u);
  const double gamma = std::max(now.a, std::sqrt(-now.b));
  stiffness_ = gamma * jacobian_->size(u);
  if (preconditioner_) preconditioner_->begin_stage(*jacobian_, now.dt);
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

/// Returns whether the SNES solves linear equations, without iterations.
bool stage_solver::is_linear() const {
  PetscBool linear = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(snes_), SNESKSPONLY, &linear));
  return linear == PETSC_TRUE;
}

/// Returns whether Q changes an unknown by more than its size in the time √−b of the second derivative.
/// Linear equations have one root.
bool stage_solver::is_far_from_equilibrium(Vec u) {
  if (is_linear()) return false;
  const Vec rate = rate_.like(u);
  of_.minus_collision(now_.t, u, rate);
  PetscReal largest = 0.0;
  check(VecMaxPointwiseDivide(rate, u, &largest));
  return std::sqrt(-now_.b) * largest > 1.0;
}

/// Solves the stage from the start u, if necessary with a new preconditioner in each iteration.
bool stage_solver::iterate(Vec u) {
  snes_lags_ = has_lag(snes_);
  renewal_ = snes_lags_ ? renewal::all : is_linear() ? renewal::changed : renewal::distant;
  if (!preconditioner_ || snes_lags_) return try_iterate(u);
  start_.assign(u);
  if (try_iterate(u)) return true;
  if (!has_kept_) return false;
  renewal_ = renewal::all;
  check(VecCopy(start_.get(), u));
  return try_iterate(u);
}

bool stage_solver::try_iterate(Vec u) {
  last_correction_ = 0.0;
  has_kept_ = false;
  // During Newton's method the entries of its matrix may change, but not the matrix object. If the program
  // chose when SNES evaluates matrices, SNES decides on the first one, too.
  linearize(u, snes_lags_ ? renewal::none : renewal_);
  const Mat p = matrix_ != nullptr ? matrix_ : operator_.get();
  if (p != snes_->jacobian_pre) check(SNESSetJacobian(snes_, operator_.get(), p, nullptr, nullptr));
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
  linearize(v, renewal_);
}

void stage_solver::linearize(Vec v, renewal which) {
  jacobian_->evaluate(now_.t, v);
  if (settings_.curvature && now_.b != 0.0) {
    base_.assign(v);
    of_.minus_collision(now_.t, v, rate_.like(v));
  }
  if (preconditioner_) {
    matrix_ = preconditioner_->prepare(*jacobian_, now_.a, now_.b, stiffness_, which);
    has_kept_ = has_kept_ || preconditioner_->is_kept();
  }
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
  PetscInt iterations = 0;
  check(KSPGetIterationNumber(ksp, &iterations));
  if (preconditioner_) preconditioner_->finish_solve(iterations);
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
  if (ratio > slow && preconditioner_) preconditioner_->renew_next();
  const double contraction = std::max(ratio, std::min(0.1, std::sqrt(epsilon) * stiffness_));
  if (contraction < 1.0 && contraction / (1.0 - contraction) * of_correction <= wanted)
    return SNES_CONVERGED_SNORM_RELATIVE;
  // Corrections that do not become smaller are rounding errors of Q, multiplied by γJ.
  const bool is_rounding = ratio >= 0.5 && of_correction <= std::min(8.0 * epsilon * stiffness_, 1e-3) * of_v;
  return is_rounding ? SNES_CONVERGED_SNORM_RELATIVE : SNES_CONVERGED_ITERATING;
}

}  // namespace apsis::petsc
