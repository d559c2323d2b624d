// Available memory, read from files of /proc and /sys in the format of the kernel.
#include <apsis/exec/memory.hpp>

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <support/folder.hpp>

namespace memory_test {

namespace fs = std::filesystem;

namespace {

void write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

}  // namespace

TEST(available_memory, is_that_of_the_machine_without_control_group_limits) {
  const test_folder folder;
  const fs::path root = folder / "root";
  write(root / "proc/meminfo", "MemTotal:  8000 kB\nMemFree:  10 kB\nMemAvailable:  3000 kB\n");
  write(root / "proc/self/cgroup", "0::/user\n");
  write(root / "sys/fs/cgroup/user/memory.max", "max\n");
  write(root / "sys/fs/cgroup/user/memory.current", "5000\n");
  const auto limit = apsis::available_memory(root);
  EXPECT_EQ(limit.bytes, 3000.0 * 1024.0);
  EXPECT_EQ(limit.source, "available memory of the machine");
}

TEST(available_memory, is_the_minimum_over_nested_groups_and_counts_page_cache_as_free) {
  const test_folder folder;
  const fs::path root = folder / "root", groups = root / "sys/fs/cgroup";
  write(root / "proc/meminfo", "MemAvailable:  3000 kB\n");
  write(root / "proc/self/cgroup", "0::/outer/inner\n");
  write(groups / "outer/memory.max", "1000000\n");
  write(groups / "outer/memory.current", "900000\n");
  write(groups / "outer/memory.stat", "anon 100\nactive_file 7\ninactive_file 50000\n");
  write(groups / "outer/inner/memory.max", "2000000\n");
  write(groups / "outer/inner/memory.current", "900000\n");
  const auto limit = apsis::available_memory(root);
  EXPECT_EQ(limit.bytes, 150000.0);
  EXPECT_EQ(limit.source, "limit of the control group");
}

TEST(available_memory, supports_control_groups_of_version_1) {
  const test_folder folder;
  const fs::path root = folder / "root", group = root / "sys/fs/cgroup/memory/job";
  write(root / "proc/self/cgroup", "5:cpu:/other\n4:memory:/job\n");
  write(group / "memory.limit_in_bytes", "1000000\n");
  write(group / "memory.usage_in_bytes", "1000001\n");
  EXPECT_EQ(apsis::available_memory(root).bytes, 0.0);
}

TEST(available_memory, of_this_machine_is_positive) {
  EXPECT_GT(apsis::available_memory().bytes, 1e6);
}

}  // namespace memory_test
