#pragma once

#include <apsis/core/errors.hpp>

#include <exception>
#include <new>
#include <source_location>

#include <petscsys.h>

namespace apsis::petsc {

/// Thrown when a function of PETSc or of the user returns an error. PETSc has recorded this error.
class petsc_error : public std::exception {
 public:
  explicit petsc_error(PetscErrorCode code) : code_(code) {}
  const char* what() const noexcept override { return "an error of PETSc"; }
  PetscErrorCode code() const { return code_; }

 private:
  PetscErrorCode code_;
};

/// Throws petsc_error for an error, and adds the caller to its traceback.
inline void check(PetscErrorCode code, std::source_location at = std::source_location::current()) {
  if (code == 0) return;
  static_cast<void>(PetscError(PETSC_COMM_SELF, static_cast<int>(at.line()), at.function_name(),
                               at.file_name(), code, PETSC_ERROR_REPEAT, " "));
  throw petsc_error(code);
}

/// Reports a new error with a message; returns its code.
inline PetscErrorCode report(MPI_Comm comm, PetscErrorCode code, const char* message,
                             const std::source_location& at) {
  return PetscError(comm, static_cast<int>(at.line()), at.function_name(), at.file_name(), code,
                    PETSC_ERROR_INITIAL, "%s", message);
}

/// Calls body(). Returns 0, or the error code of the exception that it throws, so that no exception enters
/// PETSc.
template <class Body>
PetscErrorCode guarded(MPI_Comm comm, const Body& body,
                       std::source_location at = std::source_location::current()) noexcept {
  try {
    body();
    return 0;
  } catch (const petsc_error& problem) {
    return problem.code();
  } catch (const input_error& problem) {
    return report(comm, PETSC_ERR_ARG_WRONG, problem.what(), at);
  } catch (const numerical_error& problem) {
    return report(comm, PETSC_ERR_NOT_CONVERGED, problem.what(), at);
  } catch (const std::bad_alloc&) {
    return report(PETSC_COMM_SELF, PETSC_ERR_MEM,
                  "memory is exhausted (an allocation failed); use fewer unknowns", at);
  } catch (const std::exception& problem) {
    return report(comm, PETSC_ERR_LIB, problem.what(), at);
  } catch (...) {
    return report(comm, PETSC_ERR_LIB,
                  "an exception of unknown type (a callback of C++ throws); catch it there", at);
  }
}

/// Returns the communicator of an object of PETSc.
template <class Object>
MPI_Comm comm_of(Object object) {
  return PetscObjectComm(reinterpret_cast<PetscObject>(object));
}

}  // namespace apsis::petsc
