#pragma once

#include <sys/types.h>

namespace apsis::app {

/// Thrown if a command has nothing to save when it is interrupted; the program ends with exit code 130.
struct interruption {};

/// Turns the first Ctrl-C (SIGINT), SIGTERM or SIGHUP into a stop request, answered by a line on standard
/// error that names `awaited` ("the current steps"); a second one ends the program immediately. SIGHUP
/// remains ignored where it was (nohup). The text must outlive the program.
void watch_for_interrupts(const char* awaited);

/// Ends the program with exit code 130 on any of these signals, for commands that have nothing to save.
void end_on_interrupts();

/// Whether a stop was requested.
bool interrupted();

/// Forwards signals to a child process during the lifetime of this object: the first one as SIGTERM, also if
/// it came before the object was created.
class forwarded_interrupts {
 public:
  explicit forwarded_interrupts(pid_t child);
  ~forwarded_interrupts();
  forwarded_interrupts(const forwarded_interrupts&) = delete;
  forwarded_interrupts& operator=(const forwarded_interrupts&) = delete;
};

}  // namespace apsis::app
