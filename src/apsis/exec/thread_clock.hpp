#pragma once

namespace apsis {

/// Returns the CPU seconds of the calling thread, which for sequential work do not depend on the load
/// of the machine.
double thread_seconds();

}  // namespace apsis
