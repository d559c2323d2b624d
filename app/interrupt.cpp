#include "interrupt.hpp"

#include <apsis/core/errors.hpp>

#include <cerrno>
#include <csignal>
#include <cstring>

#include <unistd.h>

namespace apsis::app {
namespace {

volatile std::sig_atomic_t stop_requested = 0;
volatile pid_t child_process = 0;
const char* awaited_text = nullptr;

/// Writes a text in a signal handler by write(), which is async-signal-safe. Ignores a failure.
void write_now(const char* text) {
  if (write(STDERR_FILENO, text, std::strlen(text)) < 0) return;
}

extern "C" void note_stop(int) {
  const int number = errno;
  stop_requested = 1;
  if (child_process > 0) kill(child_process, SIGTERM);
  if (awaited_text != nullptr) {
    write_now("\ninterrupted: waiting for ");
    write_now(awaited_text);
    write_now("; a second Ctrl-C ends the program immediately\n");
  }
  errno = number;
}

extern "C" void end_program(int) {
  write_now("\ninterrupted\n");
  _exit(static_cast<int>(exit_code::interrupted));
}

void handle_signals(void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  // The default handler is restored after the first signal.
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before = {};
    sigaction(signal, &action, &before);
    // The signal stays ignored under nohup, and for background commands of some shells.
    if (before.sa_handler == SIG_IGN) sigaction(signal, &before, nullptr);
  }
}

}  // namespace

void watch_for_interrupts(const char* awaited) {
  awaited_text = awaited;
  handle_signals(note_stop);
}

void end_on_interrupts() {
  handle_signals(end_program);
}

bool interrupted() {
  return stop_requested != 0;
}

forwarded_interrupts::forwarded_interrupts(pid_t child) {
  child_process = child;
  if (interrupted()) kill(child, SIGTERM);
}

forwarded_interrupts::~forwarded_interrupts() {
  child_process = 0;
}

}  // namespace apsis::app
