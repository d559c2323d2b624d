#include "interrupt.hpp"

#include <csignal>

namespace apsis::app {
namespace {

volatile std::sig_atomic_t stop_requested = 0;

extern "C" void note_stop(int) {
  stop_requested = 1;
}

}  // namespace

void watch_for_interrupts() {
  struct sigaction action = {};
  action.sa_handler = note_stop;
  // The default comes back after the first signal.
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // The terminal was closed; under nohup that is ignored, and stays so.
  struct sigaction now = {};
  if (sigaction(SIGHUP, nullptr, &now) == 0 && now.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

bool interrupted() {
  return stop_requested != 0;
}

}  // namespace apsis::app
