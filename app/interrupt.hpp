#pragma once

#include <sys/types.h>

namespace apsis::app {

/// Thrown where a command has nothing to keep when it is interrupted; the program ends with exit code 130.
struct interruption {};

/// Turns the first Ctrl-C (SIGINT), SIGTERM or SIGHUP into a request to stop, answered by a line on standard
/// error that names `awaited` ("the steps under way"); a second one ends the program immediately. SIGHUP
/// stays ignored where it was (nohup). The text must outlive the program.
void watch_for_interrupts(const char* awaited);

/// Ends the program with exit code 130 on any of these signals, for commands that have nothing to keep.
void end_on_interrupts();

/// Whether a stop was requested.
bool interrupted();

/// Passes signals on to a child process as long as this object lives: the first one as SIGTERM, also if it
/// came before the object was made.
class forwarded_interrupts {
 public:
  explicit forwarded_interrupts(pid_t child);
  ~forwarded_interrupts();
  forwarded_interrupts(const forwarded_interrupts&) = delete;
  forwarded_interrupts& operator=(const forwarded_interrupts&) = delete;
};

}  // namespace apsis::app
