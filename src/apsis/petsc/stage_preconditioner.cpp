#include "internal/stage_preconditioner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <petscksp.h>

namespace apsis::petsc {

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
      const PC own = of(pc).now_->pc.get();
      of(pc).follow_reuse();
      check(PCSetUp(own));
      check(PCGetFailedReason(own, &reason));
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

stage_preconditioner::stage_preconditioner(KSP ksp, preconditioner_form form) : ksp_(ksp), form_(form) {
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

stage_preconditioner::entry& stage_preconditioner::find(const collision_jacobian& j, double a, double b,
                                                        bool squared) {
  // One matrix serves all stages with the same γ.
  const double of_a = squared && b != 0.0 ? std::sqrt(-b) : a, of_b = squared ? 0.0 : b;
  const auto known = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const entry& one) { return one.a == of_a && one.b == of_b; });
  if (known != entries_.end()) return *known;
  constexpr std::size_t most = 16;  // stages of the longest method of the catalogue
  if (j.constant() && entries_.size() >= most) entries_.clear();
  if (j.constant() || entries_.empty()) {
    entries_.push_back({});
    if (entries_.size() == 1) entries_.back().pc = own_;
  }
  entry& made = entries_.back();
  made.a = of_a;
  made.b = of_b;
  made.version = -1;
  return made;
}

Mat stage_preconditioner::prepare(const collision_jacobian& j, double a, double b, double stiffness) {
  constexpr double most = 1e7;  // its square leaves two digits of the identity
  const bool squared = form_ == preconditioner_form::squared ||
                       (form_ == preconditioner_form::automatic && (!direct_ || stiffness > most));
  entry& to = find(j, a, b, squared);
  if (to.version != j.version()) {
    if (to.b == 0.0)
      assemble_shifted(to, j.entries());
    else
      assemble_polynomial(to, j.entries());
    to.version = j.version();
  }
  if (!to.pc) copy_pc(to);
  check(PCSetOperators(to.pc.get(), to.matrix.get(), to.matrix.get()));
  now_ = &to;
  twice_ = squared && b != 0.0;
  return to.matrix.get();
}

void stage_preconditioner::apply(Vec x, Vec y) {
  follow_reuse();
  check(PCApply(now_->pc.get(), x, y));
}

void stage_preconditioner::follow_reuse() const {
  PetscBool reuse = PETSC_FALSE;
  check(PCGetReusePreconditioner(shell_.get(), &reuse));
  check(PCSetReusePreconditioner(now_->pc.get(), reuse));
}

void stage_preconditioner::assemble_shifted(entry& to, Mat minus_j) {
  // The pattern may gain a diagonal that −J does not have.
  if (!to.matrix)
    check(MatDuplicate(minus_j, MAT_DO_NOT_COPY_VALUES, to.matrix.receive()));
  else
    check(MatZeroEntries(to.matrix.get()));
  check(MatAXPY(to.matrix.get(), to.a, minus_j, SUBSET_NONZERO_PATTERN));
  check(MatShift(to.matrix.get(), 1.0));
}

void stage_preconditioner::assemble_polynomial(entry& to, Mat minus_j) {
  if (!to.has_square) to.matrix.reset();
  to.has_square = true;
  check(MatMatMult(minus_j, minus_j, square_ ? MAT_REUSE_MATRIX : MAT_INITIAL_MATRIX, PETSC_DEFAULT,
                   square_.place()));
  // The first matrix determines the pattern, which contains those of J and of the identity.
  if (!to.matrix) {
    check(MatDuplicate(square_.get(), MAT_COPY_VALUES, to.matrix.receive()));
    check(MatScale(to.matrix.get(), -to.b));
    check(MatAXPY(to.matrix.get(), to.a, minus_j, DIFFERENT_NONZERO_PATTERN));
  } else {
    check(MatZeroEntries(to.matrix.get()));
    check(MatAXPY(to.matrix.get(), -to.b, square_.get(), SUBSET_NONZERO_PATTERN));
    check(MatAXPY(to.matrix.get(), to.a, minus_j, SUBSET_NONZERO_PATTERN));
  }
  check(MatShift(to.matrix.get(), 1.0));
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
