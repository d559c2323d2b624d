#include <apsis/exec/processes.hpp>

#include "processes.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/core/printable.hpp>
#include <apsis/exec/launcher.hpp>

#include <cstdio>
#include <exception>
#include <limits>
#include <new>
#include <string>

#include <fmt/format.h>

namespace apsis::app {
namespace {

bool joined = false;  // whether on_all_processes() has started, which shares all later errors

/// Reports an error that cannot reach the other processes, and ends all processes with its exit code.
void abort_all(const communicator& processes, const std::exception_ptr& mine) {
  exit_code code = exit_code::internal;
  std::string message;
  try {
    std::rethrow_exception(mine);
  } catch (const error& failure) {
    code = failure.code();
    message = failure.what();
  } catch (const std::bad_alloc&) {
    code = exit_code::numerical;
    message = "not enough memory";
  } catch (const std::exception& failure) {
    message = failure.what();
  } catch (...) {
    message = "an exception without a message";
  }
  std::fputs(fmt::format("error: process {}: {}\n", processes.rank(), printable(message)).c_str(), stderr);
  processes.abort(static_cast<int>(code));
}

}  // namespace

int on_all_processes(const std::function<int(const std::shared_ptr<communicator>&)>& body, double patience) {
  joined = true;
  const std::shared_ptr<communicator> processes = launched_processes();
  if (!processes->is_root()) log::set_level(log::level::quiet);
  std::exception_ptr failure;
  int code = 0;
  try {
    code = body(processes);
  } catch (...) {
    failure = std::current_exception();
  }
  const bool all =
      processes->end_together(failure, failure ? patience : std::numeric_limits<double>::infinity());
  if (!all && !failure)
    failure = std::make_exception_ptr(
        error(exit_code::interrupted, "interrupted (another process does not end); look for its results"));
  if (!all) abort_all(*processes, failure);
  // The root reports the error.
  if (failure) std::rethrow_exception(failure);
  return code;
}

void share_early_error(const std::exception_ptr& mine) {
  if (joined || launched_count() == 1 || !has_mpi()) return;
  on_all_processes([&](const std::shared_ptr<communicator>&) -> int { std::rethrow_exception(mine); });
}

void refuse_several_processes(const char* command) {
  if (const int count = launched_count(); count > 1)
    throw input_error(
        fmt::format("command line: {} processes were started ('apsis {}' does not share its work among "
                    "processes); start one",
                    count, command));
}

bool reports_errors() {
  return launched_rank() == 0;
}

}  // namespace apsis::app
