#include "../clock.hpp"
#include "../mixed_step.hpp"
#include "../table.hpp"

#include <apsis/exec/ceilings.hpp>
#include <apsis/exec/parallel.hpp>

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::throughput_table {
namespace {

/// Rates of one turn, summed over all threads.
struct turn {
  double multiply_adds, triad, steps;
};

/// Returns the wall-clock seconds until all threads have done a job, the best of several attempts, as for
/// a ceiling.
double best_together(const job& what) {
  double best = 1e300;
  for (int attempt = 0; attempt < 3; ++attempt) {
    const double start = wall_seconds();
    parallel_for(threads(), [&](int) { what(); });
    best = std::min(best, wall_seconds() - start);
  }
  return best;
}

turn measure_turn(mixed_step& run, int steps) {
  constexpr double count = 1e7;
  turn now{};
  now.multiply_adds = threads() * count / best_together([] { seconds_of_multiply_adds(count); });
  // Every thread sweeps its own part of the field.
  const std::size_t part = run.numbers() / static_cast<std::size_t>(threads());
  std::vector<double> rates(static_cast<std::size_t>(threads()));
  parallel_for(threads(), [&](int k) { rates[static_cast<std::size_t>(k)] = triad_bytes_per_second(part); });
  for (const double rate : rates) now.triad += rate;
  const double start = wall_seconds();
  run.take(steps);
  now.steps = steps / (wall_seconds() - start);
  return now;
}

std::vector<nlohmann::json> row_of(const std::string& discretization, const std::string& method, int cells,
                                   const settings& options) {
  mixed_step run(discretization, method, cells);
  const auto each = run.count_work();
  const int steps = run.steps_in(options.quick ? 0.01 : 0.2);
  std::vector<double> speed, of_operations, of_bytes, binding;
  for (int k = 0; k < options.repeats; ++k) {
    const turn now = measure_turn(run, steps);
    speed.push_back(now.steps * run.point_stages());
    of_operations.push_back(now.steps * each.operations / now.multiply_adds);
    of_bytes.push_back(now.steps * each.bytes / now.triad);
    binding.push_back(std::max(of_operations.back(), of_bytes.back()));
  }
  const auto per = [&](double x) { return x / run.point_stages(); };
  return {discretization,
          method,
          threads(),
          median(speed),
          fmt::format("{:.1f}", per(each.operations)),
          fmt::format("{:.1f}", per(each.bytes)),
          fmt::format("{:.0f} %", 100.0 * median(of_operations)),
          fmt::format("{:.0f} %", 100.0 * median(of_bytes)),
          fmt::format("{:.0f} %", 100.0 * median(binding))};
}

result_table measure(const settings& options) {
  const int cells = options.quick ? 50 : 1000;
  result_table result;
  result.title = fmt::format("Throughput, N = {} × 150 velocities, positivity limiter", cells);
  result.note =
      "The table shows point·stages per second of whole steps. Operations and bytes are those of a "
      "point·stage. Operations are arithmetic instructions per number. A multiply–add counts as one, as "
      "in the ceiling, and so does a division. Bytes are the compulsory memory traffic. Ceilings are "
      "multiply–adds in registers, and the triad on arrays of the length of the field. They are measured "
      "on as many threads, in the same turn.";
  result.columns = {"formulation", "method",           "threads",  "point·stages/s",        "operations",
                    "bytes",       "of multiply–adds", "of triad", "of the binding ceiling"};
  for (const int n : {1, 2})
    for (const char* discretization : {"finite-difference", "finite-volume"})
      for (const char* method : {"md-imex-3-2", "md-imex-6-3"}) {
        set_threads(n);
        result.rows.push_back(row_of(discretization, method, cells, options));
      }
  set_threads(1);
  return result;
}

const registered here({"throughput", "throughput of steps against the ceilings of the machine", measure});

}  // namespace
}  // namespace apsis::bench::throughput_table
