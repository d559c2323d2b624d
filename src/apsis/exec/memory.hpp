#pragma once

#include <filesystem>
#include <string>

namespace apsis {

/// How much more memory this process may use.
struct memory_limit {
  double bytes = 0.0;  ///< infinity where nothing is known
  std::string source;  ///< what limits it: "available memory of the machine", …
};

/// The smallest of MemAvailable of the machine, what the control groups of the process (version 1 or 2)
/// leave, with their page cache counted as free, and the limit of its address space. `root` is the root of
/// the file system that holds proc and sys; tests have their own.
memory_limit available_memory(const std::filesystem::path& root = "/");

}  // namespace apsis
