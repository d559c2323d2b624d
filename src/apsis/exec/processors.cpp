#include <apsis/exec/processors.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>
#include <thread>

#include <sched.h>

namespace apsis {
namespace {

int processors_of_affinity() {
  cpu_set_t mask;
  CPU_ZERO(&mask);
  if (sched_getaffinity(0, sizeof mask, &mask) == 0) return std::max(1, CPU_COUNT(&mask));
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

std::string first_line(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

/// Returns the control group of this process relative to /sys/fs/cgroup, such as "/user.slice"; "/" if
/// it is unknown.
std::filesystem::path control_group() {
  std::ifstream in("/proc/self/cgroup");
  for (std::string line; std::getline(in, line);)
    if (line.rfind("0::/", 0) == 0) return line.substr(3);
  return "/";
}

/// Minimum quota over the control groups of this process; 0 means no limit.
int processors_of_groups() {
  const std::filesystem::path root = "/sys/fs/cgroup";
  int least = 0;
  for (std::filesystem::path group = control_group().lexically_normal();; group = group.parent_path()) {
    const int granted = processors_of_quota(first_line(root / group.relative_path() / "cpu.max"));
    if (granted > 0) least = least == 0 ? granted : std::min(least, granted);
    if (!group.has_relative_path()) return least;
  }
}

}  // namespace

int processors_of_quota(std::string_view cpu_max) {
  std::istringstream in{std::string(cpu_max)};
  double quota = 0.0, period = 0.0;
  if (!(in >> quota >> period) || !(quota > 0.0) || !(period > 0.0)) return 0;  // "max 100000": no limit
  return static_cast<int>(std::min(std::ceil(quota / period), 1e6));
}

int available_processors() {
  static const int granted = processors_of_groups();
  const int allowed = processors_of_affinity();
  return granted > 0 ? std::min(allowed, granted) : allowed;
}

}  // namespace apsis
