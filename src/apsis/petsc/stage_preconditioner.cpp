#include "internal/stage_preconditioner.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <petsc/private/petscimpl.h>
#include <petscsnes.h>

namespace apsis::petsc {
namespace {

/// Whether numbers differ by rounding alone.
bool is_equal(double x, double y) {
  return std::abs(x - y) <= 1e-12 * std::abs(y);
}

}  // namespace

bool has_lag(SNES snes) {
  PetscInt of_matrices = 1, of_preconditioners = 1;
  check(SNESGetLagJacobian(snes, &of_matrices));
  check(SNESGetLagPreconditioner(snes, &of_preconditioners));
  if (of_matrices != 1 || of_preconditioners != 1) return true;
  const auto object = reinterpret_cast<PetscObject>(snes);
  PetscOptions options = nullptr;
  const char* prefix = nullptr;
  check(PetscObjectGetOptions(object, &options));
  check(SNESGetOptionsPrefix(snes, &prefix));
  for (const char* name : {"-snes_lag_jacobian", "-snes_lag_preconditioner"}) {
    PetscBool given = PETSC_FALSE;
    check(PetscOptionsHasName(options, prefix, name, &given));
    if (given == PETSC_TRUE) return true;
  }
  return false;
}

/// Callbacks of the shell preconditioner.
struct stage_preconditioner::callbacks {
  static stage_preconditioner& of(PC pc) {
    void* context = nullptr;
    check(PCShellGetContext(pc, static_cast<void*>(&context)));
    return *static_cast<stage_preconditioner*>(context);
  }
  static PetscErrorCode apply(PC pc, Vec x, Vec y) {
    return guarded(comm_of(pc), [&] { of(pc).apply(x, y); });
  }
  static PetscErrorCode set_up(PC pc) {
    return guarded(comm_of(pc), [&] {
      PCFailedReason reason = PC_NOERROR;
      of(pc).set_up();
      check(PCGetFailedReason(of(pc).now_->pc.get(), &reason));
      check(PCSetFailedReason(pc, reason));
    });
  }
  static PetscErrorCode view(PC pc, PetscViewer viewer) {
    return guarded(comm_of(pc), [&] {
      check(PetscViewerASCIIPrintf(viewer, "  for %s, by the preconditioner:\n",
                                   of(pc).twice_ ? "1 - gamma J on both sides, gamma = sqrt(-b)"
                                                 : "the assembled matrix of the stage"));
      check(PetscViewerASCIIPushTab(viewer));
      check(PCView(of(pc).own_.get(), viewer));
      check(PetscViewerASCIIPopTab(viewer));
    });
  }
};

stage_preconditioner::stage_preconditioner(KSP ksp, preconditioner_form form, long& set_ups)
    : ksp_(ksp), form_(form), set_ups_(set_ups) {
  PetscBool direct = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(ksp), KSPPREONLY, &direct));
  direct_ = direct == PETSC_TRUE;
  PC pc = nullptr;
  check(KSPGetPC(ksp, &pc));
  own_ = preconditioner::share(pc);
  check(PCCreate(comm_of(ksp), shell_.receive()));
  check(PCSetType(shell_.get(), PCSHELL));
  check(PCShellSetName(shell_.get(), "preconditioner of the stages of Apsis"));
  check(PCShellSetContext(shell_.get(), this));
  check(PCShellSetApply(shell_.get(), callbacks::apply));
  check(PCShellSetSetUp(shell_.get(), callbacks::set_up));
  check(PCShellSetView(shell_.get(), callbacks::view));
  check(KSPSetPC(ksp, shell_.get()));
}

stage_preconditioner::~stage_preconditioner() {
  if (in_place()) static_cast<void>(KSPSetPC(ksp_, own_.get()));
}

bool stage_preconditioner::in_place() const {
  PC pc = nullptr;
  PetscBool shell = PETSC_FALSE;
  static_cast<void>(KSPGetPC(ksp_, &pc));
  if (pc != shell_.get()) return false;
  static_cast<void>(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(pc), PCSHELL, &shell));
  return shell == PETSC_TRUE;
}

void stage_preconditioner::begin_stage(const collision_jacobian& j, double dt) {
  if (j.constant() || is_equal(dt, dt_)) return;
  dt_ = dt;
  // The next stages take their matrices and preconditioners, with the patterns.
  for (entry& one : entries_) one.version = -1;
}

/// Returns whether copy_pc() copies the preconditioner of the program: its type and its options determine it.
bool stage_preconditioner::has_copies() const {
  PCType type = nullptr;
  PetscBool found = PETSC_FALSE;
  check(PCGetType(own_.get(), &type));
  check(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(own_.get()), &found, PCNONE, PCJACOBI,
                                  PCPBJACOBI, PCVPBJACOBI, PCBJACOBI, PCSOR, PCLU, PCILU, PCCHOLESKY, PCICC,
                                  PCQR, PCGAMG, PCHYPRE, PCML, ""));
  return type == nullptr || found == PETSC_TRUE;
}

/// Returns the entry of a stage, or one that must be renewed.
stage_preconditioner::entry& stage_preconditioner::find(double a, double b, bool squared) {
  // One matrix serves all stages with the same γ.
  const double of_a = squared && b != 0.0 ? std::sqrt(-b) : a, of_b = squared ? 0.0 : b;
  const auto fits = [&](const entry& one) { return is_equal(one.a, of_a) && is_equal(one.b, of_b); };
  // Matrices with J² have another pattern.
  const auto is_free = [&](const entry& one) { return (one.b == 0.0) == (of_b == 0.0) && one.version < 0; };
  auto found = std::find_if(entries_.begin(), entries_.end(),
                            [&](const entry& one) { return one.version >= 0 && fits(one); });
  if (found != entries_.end()) return *found;
  found = std::find_if(entries_.begin(), entries_.end(), is_free);
  if (found == entries_.end() && !entries_.empty() && !has_copies()) {
    found = entries_.begin();
    if ((found->b == 0.0) != (of_b == 0.0)) {
      found->matrix.reset();
      found->set_up_for = -1;
    }
  } else if (found == entries_.end()) {
    constexpr std::size_t most = 16;  // stages of the longest method of the catalogue
    if (entries_.size() >= most) entries_.clear();
    entries_.push_back({});
    found = std::prev(entries_.end());
    if (entries_.size() == 1) found->pc = own_;
  }
  found->a = of_a;
  found->b = of_b;
  found->version = -1;
  return *found;
}

Mat stage_preconditioner::prepare(const collision_jacobian& j, double a, double b, double stiffness,
                                  renewal which) {
  constexpr double most = 1e7;  // its square leaves two digits of the identity
  const bool squared = form_ == preconditioner_form::squared ||
                       (form_ == preconditioner_form::automatic && (!direct_ || stiffness > most));
  entry& to = find(a, b, squared);
  if (to.version < 0) {
    renew(to, j);
  } else if (to.version != j.version() && which != renewal::none) {
    // Without a Krylov method, the distance is a bound of the rate of Newton's method.
    const double near = which == renewal::changed ? 1e-12 : direct_ ? 0.01 : 0.03;
    if (which == renewal::all || to.slow || !keep(to, j, near)) renew(to, j);
  }
  if (!to.pc) copy_pc(to);
  check(PCSetOperators(to.pc.get(), to.matrix.get(), to.matrix.get()));
  now_ = &to;
  twice_ = squared && b != 0.0;
  return to.matrix.get();
}

void stage_preconditioner::renew(entry& one, const collision_jacobian& j) {
  assemble(one.matrix, one.a, one.b, j.entries());
  one.version = j.version();
  one.kept = one.slow = false;
}

/// Keeps a matrix of an earlier J if its distance to that of the present J is at most `most`. Returns whether
/// it does.
bool stage_preconditioner::keep(entry& one, const collision_jacobian& j, double most) {
  constexpr double least = 1e-6;
  PetscBool has_norm = PETSC_FALSE;
  PetscReal distance = 0.0;
  check(MatHasOperation(one.matrix.get(), MATOP_NORM, &has_norm));
  if (has_norm == PETSC_FALSE) return false;
  mat& present = one.b == 0.0 ? shifted_ : polynomial_;
  assemble(present, one.a, one.b, j.entries());
  check(MatAXPY(present.get(), -1.0, one.matrix.get(), SUBSET_NONZERO_PATTERN));
  check(MatNorm(present.get(), NORM_INFINITY, &distance));
  if (!(distance <= most)) return false;
  one.version = j.version();
  // Rounding errors, and those of differences, slow no iteration.
  one.kept = distance > least;
  return true;
}

void stage_preconditioner::finish_solve(PetscInt iterations) {
  if (now_ == nullptr) return;
  if (!now_->kept)
    now_->iterations = iterations;
  else if (iterations > 2 * now_->iterations + 2)
    renew_next();
}

void stage_preconditioner::apply(Vec x, Vec y) {
  set_up();
  check(PCApply(now_->pc.get(), x, y));
}

/// Sets up the present preconditioner if its matrix has changed, unless -snes_lag_preconditioner keeps it.
/// SNES decides this after prepare().
void stage_preconditioner::set_up() {
  PetscBool reuse = PETSC_FALSE;
  PetscObjectState state = 0;
  check(PCGetReusePreconditioner(shell_.get(), &reuse));
  check(PCSetReusePreconditioner(now_->pc.get(), reuse));
  check(PetscObjectStateGet(reinterpret_cast<PetscObject>(now_->matrix.get()), &state));
  if (now_->set_up_for < 0 || (reuse == PETSC_FALSE && state != now_->set_up_for)) {
    ++set_ups_;
    now_->set_up_for = state;
  }
  check(PCSetUp(now_->pc.get()));
}

/// to ← 1 − aJ − bJ².
void stage_preconditioner::assemble(mat& to, double a, double b, Mat minus_j) {
  if (b != 0.0) return assemble_polynomial(to, a, b, minus_j);
  // The pattern may gain a diagonal that −J does not have.
  if (!to)
    check(MatDuplicate(minus_j, MAT_DO_NOT_COPY_VALUES, to.receive()));
  else
    check(MatZeroEntries(to.get()));
  check(MatAXPY(to.get(), a, minus_j, SUBSET_NONZERO_PATTERN));
  check(MatShift(to.get(), 1.0));
}

void stage_preconditioner::assemble_polynomial(mat& to, double a, double b, Mat minus_j) {
  check(MatMatMult(minus_j, minus_j, square_ ? MAT_REUSE_MATRIX : MAT_INITIAL_MATRIX, PETSC_DEFAULT,
                   square_.place()));
  // The first matrix determines the pattern, which contains those of J and of the identity.
  if (!to) {
    check(MatDuplicate(square_.get(), MAT_COPY_VALUES, to.receive()));
    check(MatScale(to.get(), -b));
    check(MatAXPY(to.get(), a, minus_j, DIFFERENT_NONZERO_PATTERN));
  } else {
    check(MatZeroEntries(to.get()));
    check(MatAXPY(to.get(), -b, square_.get(), SUBSET_NONZERO_PATTERN));
    check(MatAXPY(to.get(), a, minus_j, SUBSET_NONZERO_PATTERN));
  }
  check(MatShift(to.get(), 1.0));
}

void stage_preconditioner::copy_pc(entry& to) {
  const char* prefix = nullptr;
  PCType type = nullptr;
  DM dm = nullptr;
  check(PCGetOptionsPrefix(own_.get(), &prefix));
  check(PCGetType(own_.get(), &type));
  check(PCGetDM(own_.get(), &dm));
  check(PCCreate(comm_of(ksp_), to.pc.receive()));
  check(PCSetOptionsPrefix(to.pc.get(), prefix));
  if (dm != nullptr) check(PCSetDM(to.pc.get(), dm));
  if (type != nullptr) check(PCSetType(to.pc.get(), type));
  check(PCSetFromOptions(to.pc.get()));
}

}  // namespace apsis::petsc
