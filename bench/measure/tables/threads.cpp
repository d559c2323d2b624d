#include "../clock.hpp"
#include "../mixed_step.hpp"
#include "../table.hpp"

#include <apsis/core/ceilings.hpp>
#include <apsis/core/parallel.hpp>

#include <fmt/format.h>

namespace apsis::bench {
namespace {

/// What the machine itself gives: the same multiply–adds on one thread, and on two at once.
double ideal(int repeats) {
  constexpr double count = 2e8;
  const auto seconds = in_turns({[] { seconds_of_multiply_adds(count); },
                                 [] {
                                   set_threads(2);
                                   parallel_for(2, [](int) { seconds_of_multiply_adds(0.5 * count); });
                                   set_threads(1);
                                 }},
                                repeats, wall_seconds);
  return median_ratio(seconds, 0, 1);
}

table measure(const settings& how) {
  table result;
  result.title = "Two threads against one";
  result.note =
      "Ratio of wall times of the same steps, in turns. \"The machine\" is that ratio for multiply–adds in "
      "registers, which "
      "share nothing: what the two cores give at the time.";
  result.columns = {"formulation", "N",          "ms per step, 1 thread", "ms per step, 2 threads",
                    "ratio",       "the machine"};
  const std::vector<int> sizes = how.quick ? std::vector<int>{40} : std::vector<int>{40, 400, 4000};
  for (const char* formulation : {"finite-difference", "finite-volume"})
    for (const int cells : sizes) {
      mixed_step run(formulation, "md-imex-3-2", cells);
      // Short jobs and many turns: one disturbance spoils one turn.
      const int steps = run.steps_in(how.quick ? 0.01 : 0.04), turns = how.quick ? 1 : 5 * how.repeats;
      const auto seconds = in_turns({[&] { run.take(steps); },
                                     [&] {
                                       set_threads(2);
                                       run.take(steps);
                                       set_threads(1);
                                     }},
                                    turns, wall_seconds);
      result.rows.push_back(
          {formulation, cells, 1e3 * median(seconds[0]) / steps, 1e3 * median(seconds[1]) / steps,
           fmt::format("{:.2f}", median_ratio(seconds, 0, 1)), fmt::format("{:.2f}", ideal(turns))});
    }
  return result;
}

const registered here({"threads", "two threads against one", measure});

}  // namespace
}  // namespace apsis::bench
