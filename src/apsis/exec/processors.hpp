#pragma once

#include <string_view>

namespace apsis {

/// Returns the number of processors available to this process, at least 1: those of its affinity mask, or
/// fewer if the CPU quota of a control group is smaller.
int available_processors();

/// Returns the number of processors for one of `sharing` processes of a run on this machine, at least 1.
int available_processors(int sharing);

/// Returns the number of processors that a line "quota period" of cpu.max (cgroup version 2) grants, rounded
/// up; 0 if it sets no limit or cannot be parsed.
int processors_of_quota(std::string_view cpu_max);

}  // namespace apsis
