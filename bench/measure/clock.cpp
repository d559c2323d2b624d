#include "clock.hpp"

#include <algorithm>
#include <cstddef>
#include <ctime>

namespace apsis::bench {
namespace {

double read(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

double cpu_seconds() {
  return read(CLOCK_PROCESS_CPUTIME_ID);
}
double wall_seconds() {
  return read(CLOCK_MONOTONIC);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

std::vector<std::vector<double>> in_turns(const std::vector<job>& jobs, int repeats, double (*now)()) {
  std::vector<std::vector<double>> seconds(jobs.size());
  for (int turn = 0; turn <= repeats; ++turn)
    for (std::size_t j = 0; j < jobs.size(); ++j) {
      const double start = now();
      jobs[j]();
      if (turn > 0) seconds[j].push_back(now() - start);
    }
  return seconds;
}

std::vector<double> median_seconds(const std::vector<job>& jobs, int repeats, double (*now)()) {
  std::vector<double> medians;
  for (auto& values : in_turns(jobs, repeats, now)) medians.push_back(median(std::move(values)));
  return medians;
}

double median_ratio(const std::vector<std::vector<double>>& seconds, std::size_t numerator,
                    std::size_t denominator) {
  std::vector<double> ratios;
  for (std::size_t turn = 0; turn < seconds[numerator].size(); ++turn)
    ratios.push_back(seconds[numerator][turn] / seconds[denominator][turn]);
  return median(std::move(ratios));
}

}  // namespace apsis::bench
