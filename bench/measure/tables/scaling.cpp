#include "../clock.hpp"
#include "../mixed_step.hpp"
#include "../table.hpp"

#include <apsis/exec/ceilings.hpp>

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::scaling_table {
namespace {

/// Returns the cost of a point·stage in units of a multiply–add. Both are measured at the same time, to
/// eliminate a drift of the clock rate from one size to the next.
double cost_in_multiply_adds(mixed_step& run, int steps, int repeats, std::vector<double>& seconds) {
  constexpr double count = 4e7;
  std::vector<double> costs;
  for (int turn = 0; turn < repeats; ++turn) {
    const double before = seconds_of_multiply_adds(count), start = thread_seconds();
    run.take(steps);
    const double step = (thread_seconds() - start) / steps, after = seconds_of_multiply_adds(count);
    seconds.push_back(step);
    costs.push_back(step / run.point_stages() / (0.5 * (before + after) / count));
  }
  return median(costs);
}

result_table measure(const settings& options) {
  result_table result;
  result.title = "Cost of a step against its size";
  result.note =
      "The table shows steps of finite differences with md-imex-3-2 and 150 velocities on one thread. "
      "Column `in multiply–adds` is the time per point·stage divided by the time per multiply–add (one "
      "of the eight of a vector). The two times are measured alternately. Three fields of this size are "
      "in use.";
  result.columns = {"points",           "MB per field", "ms per step", "ns per point·stage",
                    "in multiply–adds", "against 10⁶"};
  const std::vector<double> sizes =
      options.quick ? std::vector<double>{1e4} : std::vector<double>{1e4, 1e5, 1e6, 1e7, 1e8};
  std::vector<double> costs;
  for (const double points : sizes) {
    mixed_step run("finite-difference", "md-imex-3-2", static_cast<int>(points / 150.0 + 0.5));
    std::vector<double> seconds;
    const int steps = run.steps_in(options.quick ? 0.01 : 0.1);
    costs.push_back(cost_in_multiply_adds(run, steps, options.repeats, seconds));
    result.rows.push_back({fmt::format("{:.0e}", points),
                           fmt::format("{:.3g}", 8e-6 * static_cast<double>(run.numbers())),
                           1e3 * median(seconds), 1e9 * median(seconds) / run.point_stages(), costs.back()});
  }
  const double middle = costs[std::min<std::size_t>(2, costs.size() - 1)];
  for (std::size_t k = 0; k < costs.size(); ++k)
    result.rows[k].push_back(fmt::format("{:.2f}", costs[k] / middle));
  return result;
}

const registered here({"scaling", "cost of a step for 1e4 to 1e8 points", measure});

}  // namespace
}  // namespace apsis::bench::scaling_table
