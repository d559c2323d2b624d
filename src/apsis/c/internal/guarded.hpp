#pragma once

#include <apsis/apsis.h>
#include <apsis/core/errors.hpp>

#include <exception>
#include <new>
#include <string>

#include <fmt/format.h>

namespace apsis::c {

/// Thrown if a callback returns a negative number.
class callback_error : public error {
 public:
  /// `problem` states which callback failed and what it returned.
  explicit callback_error(const std::string& problem) : error(exit_code::internal, problem) {}
};

/// Throws the error for a nonzero result of a callback: numerical_error if it is positive, callback_error if
/// it is negative.
[[noreturn]] inline void throw_refusal(const char* name, int returned) {
  if (returned < 0)
    throw callback_error(
        fmt::format("the callback '{}' failed (it returned {}); check the callback", name, returned));
  throw numerical_error(fmt::format(
      "the callback '{}' rejects a state (it returned {}); reduce the time step, or check the callback", name,
      returned));
}

/// Checks the result of the callback called `name`.
inline void require_success(const char* name, int returned) {
  if (returned != 0) throw_refusal(name, returned);
}

/// Stores the current exception as the last error of this thread, and returns its apsis_status.
inline int store_exception() noexcept {
  try {
    throw;
  } catch (const callback_error& problem) {
    return apsis_store_error(APSIS_CALLBACK_ERROR, problem.what());
  } catch (const input_error& problem) {
    return apsis_store_error(APSIS_INPUT_ERROR, problem.what());
  } catch (const numerical_error& problem) {
    return apsis_store_error(APSIS_NUMERICAL_ERROR, problem.what());
  } catch (const io_error& problem) {
    return apsis_store_error(APSIS_FILE_ERROR, problem.what());
  } catch (const claim_error& problem) {
    return apsis_store_error(APSIS_CLAIM_ERROR, problem.what());
  } catch (const std::bad_alloc&) {
    return apsis_store_error(APSIS_MEMORY_ERROR,
                             "memory is exhausted (an allocation failed); use fewer unknowns");
  } catch (const std::exception& problem) {
    return apsis_store_error(APSIS_INTERNAL_ERROR, problem.what());
  } catch (...) {
    return apsis_store_error(APSIS_INTERNAL_ERROR,
                             "an exception of unknown type (a callback of C++ throws); catch it there");
  }
}

/// Returns body(), or the apsis_status of an exception that it throws. No exception leaves a function of the
/// C interface.
template <class Body>
int guarded(const Body& body) noexcept {
  try {
    return body();
  } catch (...) {
    return store_exception();
  }
}

/// Returns the object of a pointer. Throws input_error for NULL; `what` names the object.
template <class T>
T& require(T* pointer, const char* what) {
  if (pointer == nullptr) throw input_error(std::string(what) + " is NULL (a pointer is needed); give one");
  return *pointer;
}

/// Throws input_error for a function that is NULL; `what` names it.
template <class Function>
void require_function(Function* function, const char* what) {
  if (function == nullptr) throw input_error(std::string(what) + " is NULL (it is called); give one");
}

}  // namespace apsis::c
