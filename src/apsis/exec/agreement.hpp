#pragma once

#include <apsis/exec/communicator.hpp>

#include <exception>

namespace apsis {

/// Throws the same error on all processes if any of them has one. The error in the lowest cell takes
/// precedence, then that of the lowest rank. Its type, message and site are preserved. Collective: every
/// process passes its own error or nullptr.
void agree_on_errors(communicator& processes, const std::exception_ptr& mine);

/// Runs body() on every process. If one process throws, all throw the same error. body() must not make
/// collective calls.
template <class Body>
void run_collectively(communicator& processes, const Body& body) {
  if (processes.is_single()) return body();
  std::exception_ptr mine;
  try {
    body();
  } catch (...) {
    mine = std::current_exception();
  }
  agree_on_errors(processes, mine);
}

}  // namespace apsis
