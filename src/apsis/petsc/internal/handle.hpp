#pragma once

#include "calls.hpp"

#include <utility>

#include <petscsnes.h>

namespace apsis::petsc {

/// Owns a reference to an object of PETSc.
template <class Object, PetscErrorCode (*Destroy)(Object*)>
class handle {
 public:
  handle() = default;
  handle(const handle& other) : object_(other.object_) { reference(); }
  handle(handle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  handle& operator=(handle other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  ~handle() { reset(); }

  /// Returns a new reference to an object that has another owner; an empty handle for nullptr.
  static handle share(Object object) {
    handle made;
    made.object_ = object;
    made.reference();
    return made;
  }
  /// Releases the object, and returns the place for a new one.
  Object* receive() {
    reset();
    return &object_;
  }
  /// Returns the place of the object, for functions that may replace it.
  Object* place() { return &object_; }
  void reset() { static_cast<void>(Destroy(&object_)); }  // sets it to nullptr
  Object get() const { return object_; }
  explicit operator bool() const { return object_ != nullptr; }

 private:
  void reference() {
    if (object_ != nullptr) check(PetscObjectReference(reinterpret_cast<PetscObject>(object_)));
  }

  Object object_ = nullptr;
};

using mat = handle<Mat, MatDestroy>;
using preconditioner = handle<PC, PCDestroy>;
using nonlinear_solver = handle<SNES, SNESDestroy>;
using fd_coloring = handle<MatFDColoring, MatFDColoringDestroy>;

}  // namespace apsis::petsc
