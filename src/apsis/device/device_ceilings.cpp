#include <apsis/device/device_ceilings.hpp>

#include <apsis/device/internal/kernels/combine.hpp>
#include <apsis/device/internal/kernels/multiply_adds.hpp>
#include <apsis/device/internal/row_launch.hpp>

#include <algorithm>
#include <chrono>

namespace apsis {
namespace {

constexpr int attempts = 5;

/// Returns the wall-clock seconds that a device needs for a job.
template <class Job>
double seconds_of(device& on, const Job& job) {
  on.finish();
  const auto start = std::chrono::steady_clock::now();
  job();
  on.finish();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Returns the best time of several attempts at a job; the first one also loads the kernel.
template <class Job>
double best_seconds(device& on, const Job& job) {
  double best = seconds_of(on, job);
  for (int attempt = 0; attempt < attempts; ++attempt) best = std::min(best, seconds_of(on, job));
  return best;
}

}  // namespace

double copy_bytes_per_second(device& on, std::size_t count) {
  stored_numbers from(count, on.memory()), to(count, on.memory());
  on.memory().clear(from.data(), count);
  const kernels::combine::arguments copy{to.data(), static_cast<long>(count), 1, 1, {1.0}, {from.data()}};
  const double seconds = best_seconds(on, [&] { on.launch<kernels::combine>(launch_for(count), copy); });
  return 2.0 * sizeof(double) * static_cast<double>(count) / seconds;
}

double multiply_adds_per_second(device& on) {
  using kernel = kernels::multiply_adds;
  constexpr long rounds = 4096;
  constexpr double long_enough = 0.02, factor = 0.999999, addend = 1e-6;
  constexpr int most_blocks = 1 << 20;
  // Enlarges the launch until its time far exceeds that of its start.
  for (int blocks = 1;; blocks *= 2) {
    stored_numbers sums(static_cast<std::size_t>(blocks) * independent_lanes, on.memory());
    const kernel::arguments of{sums.data(), rounds, factor, addend};
    const auto job = [&] { on.launch<kernel>({blocks, independent_lanes, 0}, of); };
    if (blocks < most_blocks && seconds_of(on, job) < long_enough) continue;
    return static_cast<double>(kernel::chains * rounds) * static_cast<double>(sums.size()) /
           best_seconds(on, job);
  }
}

}  // namespace apsis
