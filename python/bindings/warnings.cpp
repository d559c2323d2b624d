#include "arrays.hpp"

#include <apsis/core/log.hpp>
#include <apsis/core/printable.hpp>

#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

namespace apsis::python {
namespace {

/// Warnings of the library that Python has not yet taken. Threads that log them do not hold the interpreter.
struct waiting_warnings {
  std::mutex mutex;
  std::vector<std::string> messages;
};

waiting_warnings& waiting() {
  static waiting_warnings instance;
  return instance;
}

void add_waiting(const std::string& message) {
  const std::lock_guard lock(waiting().mutex);
  waiting().messages.push_back(printable(message));
}

std::vector<std::string> take_warnings() {
  const std::lock_guard lock(waiting().mutex);
  return std::exchange(waiting().messages, {});
}

}  // namespace

void bind_warnings(py::module_& m) {
  log::set_warning_receiver(add_waiting);
  m.def("take_warnings", &take_warnings);
}

}  // namespace apsis::python
