#pragma once

#include <filesystem>
#include <string>

namespace apsis {

/// Memory that this process may still allocate.
struct memory_limit {
  double bytes = 0.0;  ///< infinity if no limit is known
  std::string source;  ///< the limiting resource: "available memory of the machine", …
};

/// Returns the minimum of three limits: MemAvailable of the machine, the memory left in the control groups of
/// the process, and the memory left in its address space. Control groups are of version 1 or 2; their page
/// cache counts as free. `root` is the root of the file system with proc and sys; tests substitute their own.
memory_limit available_memory(const std::filesystem::path& root = "/");

/// Makes the GNU C library retain up to 2 GiB of freed memory for later allocations; has no effect on other C
/// libraries. By default, large blocks return to the system, which has to clear the pages of each later
/// block. This concerns the whole process: programs call it, Apsis as a library does not.
void keep_freed_memory();

}  // namespace apsis
