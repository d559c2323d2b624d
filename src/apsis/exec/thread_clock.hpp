#pragma once

namespace apsis {

/// CPU seconds of the calling thread: what sequential work costs does not depend on what else the machine
/// does.
double thread_seconds();

}  // namespace apsis
