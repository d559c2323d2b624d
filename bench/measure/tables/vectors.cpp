// Gain from the vector units of the processor: the same kernels, compiled for each instruction set.
#include "../clock.hpp"
#include "../mixed_step.hpp"
#include "../table.hpp"

#include <apsis/exec/ceilings.hpp>

#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <hwy/targets.h>

namespace apsis::bench::vectors_table {
namespace {

job with(std::int64_t instructions, job body) {
  return [instructions, body = std::move(body)] {
    hwy::SetSupportedTargetsForTest(instructions);
    body();
    hwy::SetSupportedTargetsForTest(0);
  };
}

/// Measures seconds[set][turn] of `body` with each instruction set.
std::vector<std::vector<double>> with_each(const std::vector<std::int64_t>& sets, const job& body,
                                           int turns) {
  std::vector<job> jobs;
  for (const auto instructions : sets) jobs.push_back(with(instructions, body));
  return in_turns(jobs, turns);
}

result_table measure(const settings& options) {
  result_table result;
  result.title = "The same kernels in each instruction set";
  result.note =
      "The table shows the speedup of a step over scalar code. The step is that of the mixed-regime "
      "problem (40 cells, 150 velocities, md-imex-3-2, one thread). Speedups are medians over the turns. "
      "The last column has the speedup of multiply–adds in registers for comparison. It is the upper "
      "bound for the vector units of this processor.";
  result.columns = {"instruction set", "finite volumes", "finite differences", "multiply–adds"};
  const auto sets = hwy::SupportedAndGeneratedTargets();
  const int turns = options.quick ? 1 : 5 * options.repeats;
  const double seconds = options.quick ? 0.002 : 0.02;
  mixed_step averages("finite-volume", "md-imex-3-2", 40), points("finite-difference", "md-imex-3-2", 40);
  const int of_averages = averages.steps_in(seconds), of_points = points.steps_in(seconds);
  const auto fv = with_each(
                 sets, [&] { averages.take(of_averages); }, turns),
             fd = with_each(
                 sets, [&] { points.take(of_points); }, turns),
             fma = with_each(sets, [&] { seconds_of_multiply_adds(seconds * 2e9); }, turns);
  const std::size_t one_at_a_time = sets.size() - 1;  // sorted from best to worst
  const auto gain = [&](const std::vector<std::vector<double>>& all, std::size_t set) {
    return fmt::format("{:.2f}", median_ratio(all, one_at_a_time, set));
  };
  for (std::size_t set = 0; set < sets.size(); ++set)
    result.rows.push_back({hwy::TargetName(sets[set]), gain(fv, set), gain(fd, set), gain(fma, set)});
  return result;
}

const registered here({"vectors", "gain from the vector units of the processor", measure});

}  // namespace
}  // namespace apsis::bench::vectors_table
