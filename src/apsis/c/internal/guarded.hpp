#pragma once

#include <apsis/core/errors.hpp>

#include <string>

namespace apsis::c {

/// A callback returned a negative number.
class callback_error : public error {
 public:
  /// `problem` says which callback and what it returned.
  explicit callback_error(const std::string& problem) : error(exit_code::internal, problem) {}
};

/// Stores the exception that is being handled as the last error of this thread, and returns its apsis_status.
int store_exception() noexcept;

/// Returns body(), or the apsis_status of what it throws: no exception leaves a function of the C interface.
template <class Body>
int guarded(const Body& body) noexcept {
  try {
    return body();
  } catch (...) {
    return store_exception();
  }
}

/// Returns the object of a pointer. Throws input_error for NULL, which `what` names.
template <class T>
T& require(T* pointer, const char* what) {
  if (pointer == nullptr) throw input_error(std::string(what) + " is NULL (a pointer is needed); give one");
  return *pointer;
}

/// Throws input_error for a function that is NULL, which `what` names.
template <class Function>
void require_function(Function* function, const char* what) {
  if (function == nullptr) throw input_error(std::string(what) + " is NULL (it is called); give one");
}

}  // namespace apsis::c
