#include "internal/linear_systems.hpp"

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <new>

#include <fmt/format.h>
#include <sunlinsol/sunlinsol_spgmr.h>

namespace apsis::sundials {
namespace {

owned_solver make_gmres(const functions& of, const nvector& like) {
  const bool preconditioned = of.matrix != nullptr || of.preconditioner != nullptr;
  // Without it, SUNDIALS makes no solver and does not state why.
  require_operation("nvdiv", like.get()->ops->nvdiv != nullptr, "GMRES calls it");
  const int dimension = static_cast<int>(std::min<sunindextype>(N_VGetLength(like.get()), 30));
  owned_solver made(
      SUNLinSol_SPGMR(like.get(), preconditioned ? SUN_PREC_BOTH : SUN_PREC_NONE, dimension, of.context));
  if (made.get() == nullptr) throw std::bad_alloc();
  SUNLinSol_SPGMRSetMaxRestarts(made.get(), 4);
  return made;
}

}  // namespace

linear_systems::linear_systems(functions& of, const nvector& like)
    : of_(of),
      jacobian_(of, like),
      own_(of.solver == nullptr || of.matrix != nullptr ? make_gmres(of, like) : owned_solver()),
      iterative_(own_.get() != nullptr ? own_.get() : of.solver),
      first_(like.another()),
      second_(like.another()),
      between_(like.another()) {
  SUNLinSolSetATimes(iterative_, this, multiply);
  if (is_direct() || of.preconditioner != nullptr)
    SUNLinSolSetPreconditioner(iterative_, this, nullptr, precondition);
  SUNLinSolInitialize(iterative_);
  SUNLinSolSetup(iterative_, nullptr);
  if (is_direct()) SUNLinSolInitialize(of.solver);
}

int linear_systems::prepare(double a, double b, bool fresh) {
  if (a != a_ || b != b_) amplification_ = 0.0;
  a_ = a;
  b_ = b;
  gamma_ = b < 0.0 ? std::sqrt(-b) : a;
  if (is_direct()) {
    if (fresh)
      if (const int returned = jacobian_.evaluate_matrix(); returned != 0) return returned;
    of_.count(APSIS_SUNDIALS_PRECONDITIONER_SETUPS);
    SUNMatCopy(jacobian_.matrix(), of_.matrix);
    if (const int returned = SUNMatScaleAddI(-gamma_, of_.matrix); returned != 0) return returned;
    return SUNLinSolSetup(of_.solver, of_.matrix);
  }
  if (of_.preconditioner == nullptr || of_.preconditioner_setup == nullptr) return 0;
  of_.count(APSIS_SUNDIALS_PRECONDITIONER_SETUPS);
  int made = 0;
  return jacobian_.refused().keep("preconditioner_setup",
                                  of_.preconditioner_setup(jacobian_.t(), jacobian_.v(), jacobian_.k(),
                                                           fresh ? 0 : 1, &made, gamma_, of_.data));
}

int linear_systems::solve(N_Vector r, N_Vector x, N_Vector w, double tolerance) {
  N_VConst(0.0, x);
  if (is_exact()) return SUNLinSolSolve(of_.solver, of_.matrix, x, r, 0.0);
  SUNLinSolSetScalingVectors(iterative_, w, w);
  SUNLinSolSetZeroGuess(iterative_, SUNTRUE);
  const double n = static_cast<double>(N_VGetLength(x));
  const int returned = SUNLinSolSolve(iterative_, nullptr, x, r, tolerance * std::sqrt(n));
  of_.count(APSIS_SUNDIALS_LINEAR_ITERATIONS, SUNLinSolNumIters(iterative_));
  return returned;
}

bool linear_systems::is_progress(int returned) {
  return returned == 0 || returned == SUNLS_RES_REDUCED;
}

int linear_systems::multiply(void* self, N_Vector x, N_Vector z) {
  auto& s = *static_cast<linear_systems*>(self);
  N_Vector jx = s.first_.get(), jjx = s.second_.get();
  if (const int returned = s.jacobian_.product(x, jx); returned != 0) return returned;
  if (s.b_ != 0.0)
    if (const int returned = s.jacobian_.product(jx, jjx); returned != 0) return returned;
  N_VLinearSum(1.0, x, -s.a_, jx, z);
  if (s.b_ != 0.0) N_VLinearSum(1.0, z, -s.b_, jjx, z);
  if (s.b_ != 0.0 && s.curved_by_ != nullptr) {
    if (const int returned = s.jacobian_.curvature(x, s.curved_by_, jx); returned != 0) return returned;
    N_VLinearSum(1.0, z, -s.b_, jx, z);
  }
  if (!s.is_direct() && s.of_.preconditioner == nullptr)
    s.amplification_ = std::max(s.amplification_, N_VMaxNorm(z) / N_VMaxNorm(x));
  return 0;
}

void linear_systems::require_solvable(double most) const {
  // A slow component loses this factor times the rounding errors of the fast ones. These are themselves
  // roundings times this factor.
  if (amplification_ > most)
    throw numerical_error(
        fmt::format("the equation of a stage is too stiff for GMRES without a preconditioner (its matrix "
                    "multiplies a vector by "
                    "{:.2g}); give a preconditioner, a direct solver or a stage solver",
                    amplification_));
}

int linear_systems::precondition(void* self, N_Vector r, N_Vector z, double tolerance, int side) {
  auto& s = *static_cast<linear_systems*>(self);
  const bool from_both_sides = s.own_.get() != nullptr;
  if (from_both_sides && s.b_ == 0.0 && side == 2) {
    N_VScale(1.0, r, z);
    return 0;
  }
  if (from_both_sides || s.b_ == 0.0) return s.precondition_once(r, z, tolerance, 1);
  if (const int returned = s.precondition_once(r, s.between_.get(), tolerance, side); returned != 0)
    return returned;
  return s.precondition_once(s.between_.get(), z, tolerance, side);
}

int linear_systems::precondition_once(N_Vector r, N_Vector z, double tolerance, int side) {
  if (is_direct()) return SUNLinSolSolve(of_.solver, of_.matrix, z, r, 0.0);
  of_.count(APSIS_SUNDIALS_PRECONDITIONER_SOLVES);
  return jacobian_.refused().keep(
      "preconditioner", of_.preconditioner(jacobian_.t(), jacobian_.v(), jacobian_.k(), r, z, gamma_,
                                           tolerance, side, of_.data));
}

}  // namespace apsis::sundials
