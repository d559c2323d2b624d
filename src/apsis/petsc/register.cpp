#include "internal/ts_apsis.hpp"

#include <apsis/apsis_petsc.h>

#include <array>
#include <cstring>
#include <memory>

#include <fmt/format.h>

namespace apsis::petsc {
namespace {

// Operations of the type
// --------------------------------------------------------------------------------------

PetscErrorCode set_up(TS ts) {
  return guarded(comm_of(ts), [&] { ts_apsis::of(ts).set_up(); });
}
PetscErrorCode reset(TS ts) {
  return guarded(comm_of(ts), [&] { ts_apsis::of(ts).reset(); });
}
PetscErrorCode step(TS ts) {
  return guarded(comm_of(ts), [&] { ts_apsis::of(ts).step(); });
}
PetscErrorCode roll_back(TS ts) {
  return guarded(comm_of(ts), [&] { ts_apsis::of(ts).roll_back(); });
}
PetscErrorCode interpolate(TS ts, PetscReal t, Vec out) {
  return guarded(comm_of(ts), [&] { ts_apsis::of(ts).interpolate(t, out); });
}
PetscErrorCode evaluate_step(TS ts, PetscInt order, Vec out, PetscBool* done) {
  return guarded(comm_of(ts), [&] { ts_apsis::of(ts).evaluate_step(order, out, done); });
}
PetscErrorCode evaluate_error(TS ts, NormType norm, PetscInt* order, PetscReal* error) {
  return guarded(comm_of(ts), [&] { ts_apsis::of(ts).evaluate_error(norm, order, error); });
}
PetscErrorCode view(TS ts, PetscViewer viewer) {
  return guarded(comm_of(ts), [&] { ts_apsis::of(ts).view(viewer); });
}
PetscErrorCode residual(SNES snes, Vec v, Vec r, TS ts) {
  return guarded(comm_of(snes), [&] { ts_apsis::of(ts).stages().residual(v, r); });
}

constexpr std::array forms = {"auto", "squared", "assembled"};

PetscErrorCode set_from_options(TS ts, PetscOptionItems* PetscOptionsObject) {
  return guarded(comm_of(ts), [&] {
    auto& self = ts_apsis::of(ts);
    ts_settings& now = self.settings();
    std::array<char, 512> name{};
    PetscBool given = PETSC_FALSE;
    const auto choose = [&](const char* option, const char* text, bool& value) {
      PetscBool chosen = value ? PETSC_TRUE : PETSC_FALSE;
      check(PetscOptionsBool(option, text, "", chosen, &chosen, nullptr));
      value = chosen == PETSC_TRUE;
    };
    check(PetscOptionsString("-ts_apsis_method", "Method: a name, or a file FILE.toml", "TSApsisSetMethod",
                             now.method.c_str(), name.data(), name.size(), &given));
    if (given == PETSC_TRUE) self.set_method(name.data());
    choose("-ts_apsis_fully_implicit", "Treat the RHSFunction implicitly", now.fully_implicit);
    PetscInt form = static_cast<PetscInt>(now.stages.form);
    check(PetscOptionsEList("-ts_apsis_pc", "Preconditioner of stages", "", forms.data(),
                            static_cast<PetscInt>(forms.size()), forms[static_cast<std::size_t>(form)], &form,
                            nullptr));
    now.stages.form = static_cast<preconditioner_form>(form);
    choose("-ts_apsis_curvature", "Use the derivative of the Jacobian in Newton's method",
           now.stages.curvature);
    choose("-ts_apsis_constant_jacobian", "Evaluate the Jacobian of Q once", now.stages.constant_jacobian);
    PetscReal step = now.forward_euler_step.value_or(0.0);
    check(PetscOptionsReal("-ts_apsis_ssp_step", "Forward Euler step of the RHSFunction that limits steps",
                           "TSApsisSetForwardEulerStep", step, &step, &given));
    if (given == PETSC_TRUE) now.forward_euler_step = step;
    self.forget();
  });
}

// Functions of the interface for a TS of this type
// --------------------------------------------------------------

PetscErrorCode set_method(TS ts, const char* name) {
  return guarded(comm_of(ts), [&] { ts_apsis::of(ts).set_method(name); });
}
PetscErrorCode get_method(TS ts, const char** name) {
  *name = ts_apsis::of(ts).the_method().name.c_str();
  return 0;
}
PetscErrorCode set_fully_implicit(TS ts, PetscBool fully_implicit) {
  ts_apsis::of(ts).settings().fully_implicit = fully_implicit == PETSC_TRUE;
  ts_apsis::of(ts).forget();
  return 0;
}
PetscErrorCode set_forward_euler_step(TS ts, TSApsisForwardEulerStep* function, void* context) {
  ts_settings& now = ts_apsis::of(ts).settings();
  now.forward_euler = function;
  now.forward_euler_context = context;
  ts_apsis::of(ts).forget();
  return 0;
}

/// A function that the interface finds by name in a TS.
struct composed {
  const char* name;
  void (*function)();
};

template <class Function>
void (*as_stored(Function* function))() {
  return reinterpret_cast<void (*)()>(function);
}

const std::array<composed, 4>& composed_functions() {
  static const std::array<composed, 4> all = {
      {{"TSApsisSetMethod_C", as_stored(set_method)},
       {"TSApsisGetMethod_C", as_stored(get_method)},
       {"TSApsisSetFullyImplicit_C", as_stored(set_fully_implicit)},
       {"TSApsisSetForwardEulerStep_C", as_stored(set_forward_euler_step)}}};
  return all;
}

PetscErrorCode destroy(TS ts) {
  return guarded(comm_of(ts), [&] {
    auto* self = static_cast<ts_apsis*>(ts->data);
    if (self == nullptr) return;
    self->reset();
    delete self;
    ts->data = nullptr;
    for (const auto& one : composed_functions())
      check(PetscObjectComposeFunction(reinterpret_cast<PetscObject>(ts), one.name, nullptr));
  });
}

PetscErrorCode create(TS ts) {
  return guarded(comm_of(ts), [&] {
    ts->usessnes = PETSC_TRUE;
    ts->default_adapt_type = TSADAPTNONE;
    ts->data = std::make_unique<ts_apsis>(ts).release();
    ts->ops->setup = set_up;
    ts->ops->reset = reset;
    ts->ops->destroy = destroy;
    ts->ops->setfromoptions = set_from_options;
    ts->ops->view = view;
    ts->ops->step = step;
    ts->ops->rollback = roll_back;
    ts->ops->interpolate = interpolate;
    ts->ops->evaluatestep = evaluate_step;
    ts->ops->evaluatewlte = evaluate_error;
    ts->ops->snesfunction = residual;
    for (const auto& one : composed_functions())
      check(PetscObjectComposeFunction(reinterpret_cast<PetscObject>(ts), one.name, one.function));
  });
}

/// Calls the function that a TS stores under a name. Returns false if the TS has another type.
template <class... Arguments>
bool call_composed(TS ts, const char* name, Arguments... arguments) {
  void (*found)() = nullptr;
  check(PetscObjectQueryFunction(reinterpret_cast<PetscObject>(ts), name, &found));
  if (found == nullptr) return false;
  check(reinterpret_cast<PetscErrorCode (*)(TS, Arguments...)>(found)(ts, arguments...));
  return true;
}

}  // namespace
}  // namespace apsis::petsc

using namespace apsis::petsc;

PetscErrorCode TSApsisRegister(void) {
  return guarded(PETSC_COMM_SELF, [] {
    PetscInt major = 0, minor = 0, patch = 0, release = 0;
    check(PetscGetVersionNumber(&major, &minor, &patch, &release));
    if (major != PETSC_VERSION_MAJOR || minor != PETSC_VERSION_MINOR)
      throw apsis::input_error(fmt::format(
          "the TS type 'apsis' is built for PETSc {}.{} (this is PETSc {}.{}); build it with this PETSc",
          PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, major, minor));
    check(TSInitializePackage());
    check(TSRegister(TSAPSIS, create));
  });
}

PetscErrorCode PetscDLLibraryRegister_apsis_petsc(void) {
  return TSApsisRegister();
}

PetscErrorCode TSApsisSetMethod(TS ts, const char* name) {
  return guarded(comm_of(ts), [&] { call_composed(ts, "TSApsisSetMethod_C", name); });
}

PetscErrorCode TSApsisGetMethod(TS ts, const char** name) {
  return guarded(comm_of(ts), [&] {
    *name = "";
    if (!call_composed(ts, "TSApsisGetMethod_C", name))
      throw apsis::input_error(
          "the TS has no method of Apsis (its type is not 'apsis'); call TSSetType() before");
  });
}

PetscErrorCode TSApsisSetFullyImplicit(TS ts, PetscBool fully_implicit) {
  return guarded(comm_of(ts), [&] { call_composed(ts, "TSApsisSetFullyImplicit_C", fully_implicit); });
}

PetscErrorCode TSApsisSetForwardEulerStep(TS ts, TSApsisForwardEulerStep* function, void* ctx) {
  return guarded(comm_of(ts), [&] { call_composed(ts, "TSApsisSetForwardEulerStep_C", function, ctx); });
}
