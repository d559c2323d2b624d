#pragma once

#include <apsis/exec/communicator.hpp>

#include <exception>
#include <functional>
#include <memory>

namespace apsis::app {

/// Runs body(processes) on every process that a launcher started, and returns its result. Messages are those
/// of the root. The error of a process that fails alone is thrown on all, which wait for it. If one of them
/// does not respond for `patience` seconds, the process reports its error and aborts all with the exit code
/// of the error.
int on_all_processes(const std::function<int(const std::shared_ptr<communicator>&)>& body,
                     double patience = 60.0);

/// Throws an error that was met before on_all_processes(), such as one of the command line, on all processes
/// that a launcher started; returns where there is one process.
void share_early_error(const std::exception_ptr& mine);

/// Throws input_error if a launcher started several processes: for commands that do not share their work.
void refuse_several_processes(const char* command);

/// Whether this process reports the error with which all of them end.
bool reports_errors();

}  // namespace apsis::app
