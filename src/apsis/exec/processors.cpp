#include <apsis/exec/processors.hpp>

#include <apsis/exec/control_groups.hpp>

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

/// Returns the fewest processors that a control group of this process grants; 0 means no limit.
int processors_of_groups() {
  int least = 0;
  for (const auto& group : control_groups("/sys/fs/cgroup")) {
    const int granted = processors_of_quota(first_line(group / "cpu.max"));
    if (granted > 0) least = least == 0 ? granted : std::min(least, granted);
  }
  return least;
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

int available_processors(int sharing) {
  const int all = available_processors();
  // A launcher that binds processes to processors has already divided them.
  const bool bound = processors_of_affinity() < static_cast<int>(std::thread::hardware_concurrency());
  return bound ? all : std::max(1, all / std::max(1, sharing));
}

}  // namespace apsis
