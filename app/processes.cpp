#include <apsis/exec/processes.hpp>

#include "processes.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/core/printable.hpp>
#include <apsis/exec/launcher.hpp>

#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include <fmt/format.h>

namespace apsis::app {
namespace {

exit_code code_of(const std::exception& failure) {
  if (const auto* known = dynamic_cast<const error*>(&failure)) return known->code();
  return dynamic_cast<const std::bad_alloc*>(&failure) != nullptr ? exit_code::numerical
                                                                  : exit_code::internal;
}

}  // namespace

int on_all_processes(const std::function<int(const std::shared_ptr<communicator>&)>& body, double patience) {
  const std::shared_ptr<communicator> processes = launched_processes();
  if (!processes->is_root()) log::set_level(log::level::quiet);
  try {
    return body(processes);
  } catch (const std::exception& failure) {
    // Where all fail, the root reports the error.
    if (processes->is_single() || processes->all_arrive(patience)) throw;
    std::fputs(fmt::format("error: process {}: {}\n", processes->rank(), printable(failure.what())).c_str(),
               stderr);
    processes->abort(static_cast<int>(code_of(failure)));
    throw;
  }
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
