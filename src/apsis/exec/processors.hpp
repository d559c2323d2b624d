#pragma once

#include <string_view>

namespace apsis {

/// Processors that this process may use: those of its affinity mask, or fewer where a control group grants
/// less time than they have. At least 1.
int available_processors();

/// Processors' worth of time that a line "quota period" of cpu.max grants (cgroup version 2), rounded up; 0
/// where it sets no limit or cannot be read.
int processors_of_quota(std::string_view cpu_max);

}  // namespace apsis
