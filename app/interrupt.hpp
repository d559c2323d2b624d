#pragma once

namespace apsis::app {

/// Turns the first Ctrl-C (SIGINT) or SIGTERM into a request to stop after the step that is under way; a
/// second one ends the program at once.
void watch_for_interrupts();

/// Whether a stop was requested.
bool interrupted();

}  // namespace apsis::app
