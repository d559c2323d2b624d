#pragma once

#include <apsis/exec/thread_clock.hpp>

#include <functional>
#include <vector>

namespace apsis::bench {

/// Returns the CPU time of this process in seconds, summed over its threads.
double cpu_seconds();
/// Returns the wall-clock time in seconds, for jobs on several threads.
double wall_seconds();

/// Returns the median; of an even number of values, the mean of the two middle ones. Requires at
/// least one value.
double median(std::vector<double> values);

/// Measures seconds[job][repeat] by `now`. Runs the jobs in turns, `repeats` times after one warm-up turn, so
/// that a drift of the clock rate affects all jobs equally.
using job = std::function<void()>;
std::vector<std::vector<double>> in_turns(const std::vector<job>& jobs, int repeats,
                                          double (*now)() = thread_seconds);

/// Returns the medians of `in_turns`, one for each job.
std::vector<double> median_seconds(const std::vector<job>& jobs, int repeats,
                                   double (*now)() = thread_seconds);

/// Returns the median over the turns of seconds[numerator]/seconds[denominator], the ratio of two jobs
/// measured in the same turns.
double median_ratio(const std::vector<std::vector<double>>& seconds, std::size_t numerator,
                    std::size_t denominator);

}  // namespace apsis::bench
