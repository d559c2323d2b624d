#include <apsis/exec/control_groups.hpp>

#include <fstream>

namespace apsis {
namespace fs = std::filesystem;
namespace {

/// Returns the path of the group in /proc/self/cgroup, whose lines are "number:controllers:path"; "/" if
/// unknown.
std::string group_of_process(const fs::path& root, const std::string& controller) {
  std::ifstream in(root / "proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    const auto first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    if (line.substr(first + 1, second - first - 1) == controller) return line.substr(second + 1);
  }
  return "/";
}

}  // namespace

std::vector<fs::path> control_groups(const fs::path& mount, const std::string& controller,
                                     const fs::path& root) {
  std::vector<fs::path> groups = {mount};
  for (const auto& part : fs::path(group_of_process(root, controller)).lexically_normal().relative_path())
    if (!part.empty()) groups.push_back(groups.back() / part);
  return groups;
}

}  // namespace apsis
