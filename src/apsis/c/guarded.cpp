#include "internal/guarded.hpp"

#include <apsis/apsis.h>
#include <apsis/core/printable.hpp>

#include <exception>
#include <new>

namespace apsis::c {
namespace {

/// The last error of this thread; `fixed` where memory was lacking for the text.
struct last_error {
  std::string text;
  const char* fixed = "";
};

last_error& of_this_thread() {
  thread_local last_error here;
  return here;
}

int store(int status, const char* message) noexcept {
  last_error& here = of_this_thread();
  try {
    here.text = printable(message);
    here.fixed = nullptr;
  } catch (...) {
    here.fixed = "an error without its message (memory is exhausted); use fewer unknowns";
  }
  return status;
}

}  // namespace

int store_exception() noexcept {
  try {
    throw;
  } catch (const callback_error& problem) {
    return store(APSIS_CALLBACK_ERROR, problem.what());
  } catch (const input_error& problem) {
    return store(APSIS_INPUT_ERROR, problem.what());
  } catch (const numerical_error& problem) {
    return store(APSIS_NUMERICAL_ERROR, problem.what());
  } catch (const io_error& problem) {
    return store(APSIS_FILE_ERROR, problem.what());
  } catch (const claim_error& problem) {
    return store(APSIS_CLAIM_ERROR, problem.what());
  } catch (const std::bad_alloc&) {
    return store(APSIS_MEMORY_ERROR, "memory is exhausted (an allocation failed); use fewer unknowns");
  } catch (const std::exception& problem) {
    return store(APSIS_INTERNAL_ERROR, problem.what());
  } catch (...) {
    return store(APSIS_INTERNAL_ERROR,
                 "an exception of unknown type (a callback of C++ throws); catch it there");
  }
}

}  // namespace apsis::c

const char* apsis_error_message(void) {
  const auto& here = apsis::c::of_this_thread();
  return here.fixed != nullptr ? here.fixed : here.text.c_str();
}
