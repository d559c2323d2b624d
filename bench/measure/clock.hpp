#pragma once

#include <apsis/exec/thread_clock.hpp>

#include <functional>
#include <vector>

namespace apsis::bench {

/// CPU seconds of this process, all its threads together.
double cpu_seconds();
/// Seconds of the wall clock, for what runs on several threads.
double wall_seconds();

/// The middle of the values, the mean of the two middle ones of an even number. At least one value.
double median(std::vector<double> values);

/// Seconds (by `now`) of each of the jobs, run in turns, `repeats` times after one turn that does not count:
/// the speed of a machine that drifts enters all of them alike. seconds[job][repeat].
using job = std::function<void()>;
std::vector<std::vector<double>> in_turns(const std::vector<job>& jobs, int repeats,
                                          double (*now)() = thread_seconds);

/// Medians of `in_turns`, one for each job.
std::vector<double> median_seconds(const std::vector<job>& jobs, int repeats,
                                   double (*now)() = thread_seconds);

/// Median over the turns of seconds[numerator]/seconds[denominator]: the ratio of two jobs that ran side by
/// side.
double median_ratio(const std::vector<std::vector<double>>& seconds, std::size_t numerator,
                    std::size_t denominator);

}  // namespace apsis::bench
