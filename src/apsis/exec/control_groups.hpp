#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace apsis {

/// Returns the folders under `mount` of the control groups of this process, the root first and the innermost
/// last. `controller` names a controller of cgroup version 1, such as "memory"; "" stands for version 2.
/// `root` is the root of the file system, which tests replace. In a container, /proc may contain the path on
/// the host. The group of the container is then the mount itself.
std::vector<std::filesystem::path> control_groups(const std::filesystem::path& mount,
                                                  const std::string& controller = "",
                                                  const std::filesystem::path& root = "/");

}  // namespace apsis
