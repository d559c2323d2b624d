#include "internal/ts_apsis.hpp"

namespace apsis::petsc {

void ts_apsis::view(PetscViewer viewer) const {
  PetscBool text = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(viewer), PETSCVIEWERASCII, &text));
  if (text == PETSC_FALSE) return;
  const auto coefficients = method_->coefficients<double>();
  check(PetscViewerASCIIPrintf(viewer, "  method %s: %s\n", method_->name.c_str(), method_->title.c_str()));
  check(PetscViewerASCIIPrintf(viewer, "  order %d, %d stages, kind %s, %s\n", method_->claims.order,
                               static_cast<int>(method_->stages()), to_string(method_->kind).c_str(),
                               settings_.fully_implicit || method_->kind == method_kind::implicit_only
                                   ? "RHSFunction implicit"
                                   : "RHSFunction explicit"));
  if (is_convex(coefficients, method_->kind, method_->stages()))
    check(PetscViewerASCIIPrintf(viewer, "  SSP coefficient %g\n", coefficients.r));
  else
    check(PetscViewerASCIIPrintf(viewer, "  no SSP coefficient\n"));
  check(PetscViewerASCIIPrintf(viewer, "  preconditioners of stages set up: %ld\n", stages_.set_ups()));
}

}  // namespace apsis::petsc
