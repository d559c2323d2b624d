#pragma once

#include <apsis/exec/profile.hpp>

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace apsis::app {

/// Data of `apsis run --profile`: kernels timed by the profiler, and ceilings of this machine.
struct run_profile {
  std::vector<kernel_totals> kernels;
  double seconds;               ///< wall-clock time of the run, times the number of threads
  double multiply_adds, triad;  ///< ceilings of one core: multiply–adds and bytes per second
};

/// Stops profiling and measures the ceilings. The triad has arrays of `numbers` doubles, at least 4096.
run_profile finish_profile(double wall_seconds, std::size_t numbers);

/// Returns a table: time, and operations and bytes as fractions of the ceilings.
std::string profile_text(const run_profile& profile);
nlohmann::ordered_json to_json(const run_profile& profile);

}  // namespace apsis::app
