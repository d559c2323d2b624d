#pragma once

#include <sys/types.h>

namespace apsis::app {

/// Thrown if a command has nothing to save when it is interrupted; the program ends with exit code 130.
struct interruption {};

/// Turns the first Ctrl-C (SIGINT), SIGTERM or SIGHUP into a stop request. A line on standard error then
/// names `awaited` ("the current steps"), unless it is null. A second signal ends the program immediately.
/// Ignored signals remain ignored (nohup). The text must live until the program ends.
void watch_for_interrupts(const char* awaited);

/// Ends the program with exit code 130 on any of these signals, for commands that have nothing to save.
void end_on_interrupts();

/// Whether a stop was requested.
bool interrupted();

/// Forwards the first signal to a child process as SIGTERM, during the lifetime of this object. It does so
/// even if the signal came before the object was created.
class forwarded_interrupts {
 public:
  explicit forwarded_interrupts(pid_t child);
  ~forwarded_interrupts();
  forwarded_interrupts(const forwarded_interrupts&) = delete;
  forwarded_interrupts& operator=(const forwarded_interrupts&) = delete;
};

}  // namespace apsis::app
