#include "internal/collision_jacobian.hpp"

#include <utility>

#include <petscdm.h>
#include <petscmat.h>
#include <petscts.h>

namespace apsis::petsc {
namespace {

/// Arguments of −Q for differences: its functions and the time of the Jacobian.
struct differenced {
  split_functions* of;
  double t;
};

PetscErrorCode evaluate_for_coloring(void*, Vec u, Vec out, void* context) {
  const auto& here = *static_cast<differenced*>(context);
  return guarded(comm_of(u), [&] { here.of->minus_collision(here.t, u, out); });
}

PetscErrorCode evaluate_for_product(void* context, Vec u, Vec out) {
  return evaluate_for_coloring(nullptr, u, out, context);
}

PetscErrorCode destroy_differenced(void* context) {
  delete static_cast<differenced*>(context);
  return 0;
}

constexpr const char* key_of_context = "apsis_differenced";

/// Attaches the arguments of −Q to an object of PETSc, which owns them.
template <class Object>
differenced& attach(Object object, split_functions& of) {
  auto* made = new differenced{&of, 0.0};
  PetscContainer holder = nullptr;
  check(PetscContainerCreate(comm_of(object), &holder));
  check(PetscContainerSetPointer(holder, made));
  check(PetscContainerSetUserDestroy(holder, destroy_differenced));
  check(PetscObjectCompose(reinterpret_cast<PetscObject>(object), key_of_context,
                           reinterpret_cast<PetscObject>(holder)));
  check(PetscContainerDestroy(&holder));
  return *made;
}

template <class Object>
differenced& attached(Object object) {
  PetscObject holder = nullptr;
  check(PetscObjectQuery(reinterpret_cast<PetscObject>(object), key_of_context, &holder));
  void* found = nullptr;
  check(PetscContainerGetPointer(reinterpret_cast<PetscContainer>(holder), &found));
  return *static_cast<differenced*>(found);
}

/// Returns whether the DM of a SNES provides matrices. PETSc gives a TS without a DM a DMSHELL, which
/// provides no matrices.
bool provides_matrices(SNES snes) {
  DM dm = nullptr;
  check(SNESGetDM(snes, &dm));
  PetscBool shell = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(dm), DMSHELL, &shell));
  return shell == PETSC_FALSE;
}

}  // namespace

jacobian_choice choose_jacobian(const split_functions& of, SNES snes) {
  DM dm = nullptr;
  check(SNESGetDM(snes, &dm));
  PetscErrorCode (*function)(SNES, Vec, Mat, Mat, void*) = nullptr;
  check(DMSNESGetJacobian(dm, &function, nullptr));
  PetscBool products_alone = PETSC_FALSE, matrix_free = PETSC_FALSE;
  check(SNESGetUseMatrixFree(snes, &products_alone, &matrix_free));
  const bool without_matrix = matrix_free == PETSC_TRUE && products_alone == PETSC_FALSE;
  const bool by_differences =
      function == SNESComputeJacobianDefaultColor || function == SNESComputeJacobianDefault;
  jacobian_choice chosen;
  chosen.entries =
      of.has_jacobian() && !by_differences ? jacobian_source::callback : jacobian_source::coloring;
  Mat a = nullptr, p = nullptr;
  check(SNESGetJacobian(snes, &a, &p, nullptr, nullptr));
  if (p == nullptr && !without_matrix && provides_matrices(snes)) {
    check(DMCreateMatrix(dm, chosen.p.receive()));
  } else {
    chosen.p = mat::share(p);
  }
  if (without_matrix) chosen.p.reset();
  if (!chosen.p) chosen.entries = jacobian_source::difference;
  chosen.products = products_alone == PETSC_TRUE ? jacobian_source::difference : chosen.entries;
  const bool own = chosen.products == jacobian_source::callback && a != nullptr;
  chosen.a = own ? mat::share(a) : chosen.p;
  return chosen;
}

collision_jacobian::collision_jacobian(split_functions& of, jacobian_choice choice, bool constant)
    : of_(of), choice_(std::move(choice)), constant_(constant) {
  if (choice_.products == jacobian_source::difference) choice_.a.reset();
  if (choice_.entries == jacobian_source::coloring) make_coloring();
}

void collision_jacobian::make_coloring() {
  MatColoring method = nullptr;
  ISColoring colors = nullptr;
  const Mat p = choice_.p.get();
  // A matrix of a DM has its pattern, but no entries yet.
  PetscBool assembled = PETSC_FALSE;
  check(MatAssembled(p, &assembled));
  if (assembled == PETSC_FALSE) {
    check(MatAssemblyBegin(p, MAT_FINAL_ASSEMBLY));
    check(MatAssemblyEnd(p, MAT_FINAL_ASSEMBLY));
  }
  check(MatColoringCreate(p, &method));
  check(MatColoringSetType(method, MATCOLORINGSL));
  check(MatColoringSetFromOptions(method));
  check(MatColoringApply(method, &colors));
  check(MatColoringDestroy(&method));
  check(MatFDColoringCreate(p, colors, coloring_.receive()));
  differenced& context = attach(coloring_.get(), of_);
  // PETSc stores functions of several types as one type. The cast through void (*)() shows that this is
  // deliberate.
  const auto function = reinterpret_cast<void (*)()>(evaluate_for_coloring);
  check(
      MatFDColoringSetFunction(coloring_.get(), reinterpret_cast<PetscErrorCode (*)()>(function), &context));
  check(MatFDColoringSetFromOptions(coloring_.get()));
  check(MatFDColoringSetUp(p, colors, coloring_.get()));
  check(ISColoringDestroy(&colors));
}

void collision_jacobian::make_difference(Vec u) {
  PetscInt local = 0, global = 0;
  check(VecGetLocalSize(u, &local));
  check(VecGetSize(u, &global));
  Mat* place = choice_.a.receive();
  check(MatCreateMFFD(comm_of(u), local, local, global, global, place));
  check(MatMFFDSetFunction(*place, evaluate_for_product, &attach(*place, of_)));
  check(MatSetFromOptions(*place));
}

void collision_jacobian::evaluate(double t, Vec u) {
  if (at_ && constant_) return;
  if (at_ && t == t_) {
    PetscBool same = PETSC_FALSE;
    check(VecEqual(u, at_.get(), &same));
    if (same == PETSC_TRUE) return;
  }
  at_.assign(u);
  t_ = t;
  ++version_;
  if (choice_.products == jacobian_source::difference) {
    if (!choice_.a) make_difference(u);
    attached(choice_.a.get()).t = t;
    check(MatMFFDSetBase(choice_.a.get(), at_.get(), nullptr));
    check(MatAssemblyBegin(choice_.a.get(), MAT_FINAL_ASSEMBLY));
    check(MatAssemblyEnd(choice_.a.get(), MAT_FINAL_ASSEMBLY));
  }
  if (choice_.entries == jacobian_source::coloring) {
    attached(coloring_.get()).t = t;
    check(MatFDColoringApply(choice_.p.get(), coloring_.get(), at_.get(), nullptr));
  } else if (choice_.entries == jacobian_source::callback) {
    // With products by differences, only p is needed.
    const bool both = choice_.products == jacobian_source::callback;
    of_.minus_jacobian(t, u, both ? choice_.a.get() : choice_.p.get(), choice_.p.get());
  }
}

void collision_jacobian::minus_product(Vec x, Vec y) {
  check(MatMult(choice_.a.get(), x, y));
}

double collision_jacobian::size(Vec x) {
  PetscReal norm = 0.0;
  if (choice_.p) {
    PetscBool has_norm = PETSC_FALSE;
    check(MatHasOperation(choice_.p.get(), MATOP_NORM, &has_norm));
    if (has_norm == PETSC_TRUE) {
      check(MatNorm(choice_.p.get(), NORM_INFINITY, &norm));
      return norm;
    }
  }
  PetscReal of_x = 0.0;
  minus_product(x, work_.like(x));
  check(VecNorm(x, NORM_2, &of_x));
  check(VecNorm(work_.get(), NORM_2, &norm));
  return of_x > 0.0 ? norm / of_x : 0.0;
}

}  // namespace apsis::petsc
