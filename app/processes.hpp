#pragma once

#include <apsis/exec/communicator.hpp>

#include <exception>
#include <functional>
#include <memory>

namespace apsis::app {

/// Runs body(processes) on every process that a launcher started, and returns its result. Only the root
/// writes messages. If a process fails alone, all processes that wait for it throw its error. If another
/// process does not respond for `patience` seconds after a failure, the failed one reports its error and
/// aborts all with its exit code.
int on_all_processes(const std::function<int(const std::shared_ptr<communicator>&)>& body,
                     double patience = 60.0);

/// Throws an error from before on_all_processes(), such as one of the command line, on all processes that a
/// launcher started. Returns if there is only one process.
void share_early_error(const std::exception_ptr& mine);

/// Throws input_error if a launcher started several processes; for commands that do not share their work.
void refuse_several_processes(const char* command);

/// Whether this process reports an error with which all processes end.
bool reports_errors();

}  // namespace apsis::app
