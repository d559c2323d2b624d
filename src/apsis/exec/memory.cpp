#include <apsis/exec/memory.hpp>

#include <apsis/exec/control_groups.hpp>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

namespace apsis {
namespace fs = std::filesystem;
namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();

/// Returns the number that follows `key` in a file of lines "key number"; `missing` without one.
double number_after(const fs::path& path, const std::string& key, double missing) {
  std::ifstream in(path);
  for (std::string word; in >> word;)
    if (double value = 0.0; word == key && in >> value) return value;
  return missing;
}

/// Reads the number in a file; "max" and other words mean unlimited.
double number_in(const fs::path& path) {
  std::ifstream in(path);
  double value = 0.0;
  return in >> value ? value : unknown;
}

/// Returns the bytes left in one control group. The inactive page cache counts as free, because the kernel
/// reclaims it on demand.
double left_in_group(const fs::path& group, const char* limit, const char* used, const char* cache) {
  const double most = number_in(group / limit), now = number_in(group / used);
  if (most == unknown || now == unknown) return unknown;
  return most - now + number_after(group / "memory.stat", cache, 0.0);
}

/// Returns the minimum of left_in_group() over control groups.
double left_in_groups(const std::vector<fs::path>& groups, const char* limit, const char* used,
                      const char* cache) {
  double left = unknown;
  for (const auto& group : groups) left = std::min(left, left_in_group(group, limit, used, cache));
  return left;
}

double left_of_address_space(const fs::path& root) {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unknown;
  const double pages = number_in(root / "proc/self/statm");
  if (pages == unknown) return unknown;
  return static_cast<double>(limit.rlim_cur) - pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace

memory_limit available_memory(const fs::path& root) {
  memory_limit least{unknown, "nothing known"};
  const auto consider = [&least](double bytes, const char* source) {
    if (bytes < least.bytes) least = {std::max(bytes, 0.0), source};
  };
  const fs::path groups = root / "sys/fs/cgroup";
  consider(1024.0 * number_after(root / "proc/meminfo", "MemAvailable:", unknown),
           "available memory of the machine");
  consider(left_in_groups(control_groups(groups, "", root), "memory.max", "memory.current", "inactive_file"),
           "limit of the control group");
  consider(left_in_groups(control_groups(groups / "memory", "memory", root), "memory.limit_in_bytes",
                          "memory.usage_in_bytes", "total_inactive_file"),
           "limit of the control group");
  consider(left_of_address_space(root), "limit of the address space");
  return least;
}

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int most = 0x7fffffff, largest_block_of_heap = 32 << 20;  // the largest that mallopt accepts
  mallopt(M_TRIM_THRESHOLD, most);
  mallopt(M_MMAP_THRESHOLD, largest_block_of_heap);
#endif
}

}  // namespace apsis
