#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace apsis {

/// Returns the folders under `mount` of the control groups of this process, the root first and the innermost
/// last. `controller` is "memory" or another one of cgroup version 1, "" for version 2; `root` is the root of
/// the file system, another one in tests. In a container the path in /proc may be that of the host; the group
/// of the container is then the mount itself.
std::vector<std::filesystem::path> control_groups(const std::filesystem::path& mount,
                                                  const std::string& controller = "",
                                                  const std::filesystem::path& root = "/");

}  // namespace apsis
