#pragma once

#include <apsis/exec/communicator.hpp>

#include <functional>
#include <memory>

namespace apsis::app {

/// Runs body(processes) on every process that a launcher started, and returns its result. Messages are those
/// of the root. Where a process fails alone, while others wait for it, it reports its error and ends all with
/// the exit code of the error, after `patience` seconds in which the others could have failed too.
int on_all_processes(const std::function<int(const std::shared_ptr<communicator>&)>& body,
                     double patience = 10.0);

/// Throws input_error if a launcher started several processes: for commands that do not share their work.
void refuse_several_processes(const char* command);

/// Whether this process reports the error with which all of them end.
bool reports_errors();

}  // namespace apsis::app
