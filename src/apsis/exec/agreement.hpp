#pragma once

#include <apsis/exec/communicator.hpp>

#include <exception>

namespace apsis {

/// Throws on all processes if one of them has an error: the error of the smallest cell, then of the smallest
/// rank, with its type (an exit code has one type of error), its message and its site. Collective; every
/// process passes its own error or nullptr.
void agree_on_errors(communicator& processes, const std::exception_ptr& mine);

/// Runs body(), without collective calls inside, on every process. If one throws, all throw the same error.
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
