#pragma once

namespace apsis {

/// Returns the CPU time of the calling thread in seconds. For sequential work it does not depend on the load
/// of the machine.
double thread_seconds();

}  // namespace apsis
