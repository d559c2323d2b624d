// Digits of the automatic method on the stiff problems of the literature, with tolerances of steps and of the
// end.
#include "measure/clock.hpp"
#include "measure/table.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/method/method_choice.hpp>
#include <apsis/verify/stiff_problem.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::stiff_end_table {
namespace {

struct timed_solution {
  stiff_solution solution;
  double seconds;
};

timed_solution take_time(const std::function<stiff_solution()>& solve) {
  const double begin = thread_seconds();
  auto solution = solve();
  return {std::move(solution), thread_seconds() - begin};
}

/// Returns "digits of steps → digits of the end (CPU time of both)".
std::string cell_of(const stiff_problem_entry& problem, double rtol, double most_seconds) {
  const auto name = choose_method({.general = true, .tolerance = rtol}).method;
  try {
    const auto by_steps = take_time([&] {
      return solve_stiff_problem(problem, name, rtol, std::numeric_limits<long>::max(), most_seconds);
    });
    const auto to_end =
        take_time([&] { return solve_stiff_problem_to_end(problem, name, rtol, most_seconds); });
    return fmt::format("{:.1f} → {:.1f} (× {:.1f})", by_steps.solution.digits, to_end.solution.digits,
                       to_end.seconds / by_steps.seconds);
  } catch (const numerical_error&) {
    return fmt::format("> {:g} s", most_seconds);
  }
}

result_table measure(const settings& options) {
  result_table result;
  result.title = "Tolerances of steps and of the end";
  result.note =
      "The problems, tolerances and digits are those of the first table on stiff systems, with the method "
      "that `auto` chooses. The first number has correct digits if the tolerances bound the error of each "
      "step. The second is for the error at the end (`solve_ivp(…, end_error=True)`). Brackets contain the "
      "CPU time of the latter, all its runs included, relative to the former.";
  const auto tolerances = options.quick ? std::vector<double>{1e-4} : std::vector<double>{1e-4, 1e-6, 1e-8};
  result.columns = {"problem"};
  for (const double rtol : tolerances) result.columns.push_back(fmt::format("{:.0e}", rtol));
  for (const auto* problem : stiff_problem_entries()) {
    if (options.quick && problem->slow) continue;
    result.rows.push_back({problem->name});
    for (const double rtol : tolerances)
      result.rows.back().emplace_back(cell_of(*problem, rtol, options.quick ? 2.0 : 200.0));
  }
  return result;
}

const registered here({"stiff-end", "the stiff problems of the literature with tolerances of the end",
                       measure});

}  // namespace
}  // namespace apsis::bench::stiff_end_table
