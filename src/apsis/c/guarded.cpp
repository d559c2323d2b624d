#include <apsis/apsis.h>
#include <apsis/core/printable.hpp>

#include <string>

namespace apsis::c {
namespace {

/// The last error of this thread. `fixed` replaces the text if memory is lacking for it.
struct last_error {
  std::string text;
  const char* fixed = "";
};

last_error& of_this_thread() {
  thread_local last_error here;
  return here;
}

}  // namespace
}  // namespace apsis::c

int apsis_store_error(int status, const char* message) {
  auto& here = apsis::c::of_this_thread();
  try {
    here.text = apsis::printable(message != nullptr ? message : "");
    here.fixed = nullptr;
  } catch (...) {
    here.fixed = "an error without its message (memory is exhausted); use fewer unknowns";
  }
  return status;
}

const char* apsis_error_message(void) {
  const auto& here = apsis::c::of_this_thread();
  return here.fixed != nullptr ? here.fixed : here.text.c_str();
}
