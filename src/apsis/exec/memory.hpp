#pragma once

#include <filesystem>
#include <string>

namespace apsis {

/// Memory that this process may still allocate.
struct memory_limit {
  double bytes = 0.0;  ///< infinity if no limit is known
  std::string source;  ///< the limiting resource: "available memory of the machine", …
};

/// Returns the minimum of MemAvailable of the machine, the memory left in the control groups of the process
/// (version 1 or 2, page cache counted as free), and the limit of its address space. `root` is the root of
/// the file system with proc and sys; tests substitute their own.
memory_limit available_memory(const std::filesystem::path& root = "/");

/// Makes the C library keep up to 2 GiB of freed memory for later allocations, where it is that of GNU.
/// Otherwise it returns large blocks to the system, and each later one takes pages that the system has to
/// clear. This concerns the whole process: programs call it, the library does not.
void keep_freed_memory();

}  // namespace apsis
