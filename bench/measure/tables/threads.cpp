#include "../clock.hpp"
#include "../mixed_step.hpp"
#include "../table.hpp"

#include <apsis/exec/ceilings.hpp>
#include <apsis/exec/parallel.hpp>

#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::threads_table {
namespace {

/// Returns the ideal speedup of the machine: that of multiply–adds in registers, which share nothing, from
/// one thread to two simultaneous threads. They run for about `seconds`, in `pieces` with a barrier after
/// each. A step has one piece per pass over the field.
double ideal(double seconds, int pieces, int repeats) {
  constexpr double sample = 2e7;
  const double count = seconds / seconds_of_multiply_adds(sample) * sample / pieces;
  const auto on_threads = [=](int n) {
    set_threads(n);
    for (int k = 0; k < pieces; ++k) parallel_for(n, [=](int) { seconds_of_multiply_adds(count / n); });
    set_threads(1);
  };
  return median_ratio(in_turns({[=] { on_threads(1); }, [=] { on_threads(2); }}, repeats, wall_seconds), 0,
                      1);
}

std::string two_digits(double x) {
  return fmt::format("{:.2f}", x);
}

result_table measure(const settings& options) {
  result_table result;
  result.title = "Two threads against one";
  result.note =
      "The table shows the ratio of wall times of the same steps, which were measured in turns. Column "
      "`the machine` is this ratio for multiply–adds in registers, which share nothing. It is the ideal "
      "speedup at that moment. Column `in steps` is the same ratio with as many barriers as in these "
      "steps.";
  result.columns = {"formulation", "N",       "ms per step, 1 thread", "ms per step, 2 threads", "ratio",
                    "the machine", "in steps"};
  const std::vector<int> sizes = options.quick ? std::vector<int>{40} : std::vector<int>{40, 400, 4000};
  for (const char* discretization : {"finite-difference", "finite-volume"})
    for (const int cells : sizes) {
      mixed_step run(discretization, "md-imex-3-2", cells);
      // Jobs are short and turns many, so that a disturbance affects only one turn.
      const int steps = run.steps_in(options.quick ? 0.01 : 0.04),
                turns = options.quick ? 1 : 5 * options.repeats;
      const auto seconds = in_turns({[&] { run.take(steps); },
                                     [&] {
                                       set_threads(2);
                                       run.take(steps);
                                       set_threads(1);
                                     }},
                                    turns, wall_seconds);
      const double one = median(seconds[0]), two = median(seconds[1]);
      result.rows.push_back({discretization, cells, 1e3 * one / steps, 1e3 * two / steps,
                             two_digits(median_ratio(seconds, 0, 1)), two_digits(ideal(one, 1, turns)),
                             two_digits(ideal(one, steps * run.passes(), turns))});
    }
  return result;
}

const registered here({"threads", "speedup of two threads", measure});

}  // namespace
}  // namespace apsis::bench::threads_table
