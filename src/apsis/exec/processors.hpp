#pragma once

#include <string_view>

namespace apsis {

/// Returns the number of processors available to this process, at least 1. It is the number in the affinity
/// mask, or the CPU quota of a control group if that is smaller.
int available_processors();

/// Returns the number of processors for one of `sharing` processes of a run on this machine, at least 1.
int available_processors(int sharing);

/// Returns the number of processors, rounded up, that a line "quota period" of cpu.max grants (cgroup version
/// 2). Returns 0 if the line sets no limit or cannot be parsed.
int processors_of_quota(std::string_view cpu_max);

}  // namespace apsis
