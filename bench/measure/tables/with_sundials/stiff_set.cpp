// The stiff problems of the literature, solved by Apsis and other programs.
#include "measure/clock.hpp"
#include "measure/table.hpp"
#include "peers/stiff_set.hpp"

#include <apsis/method/method.hpp>
#include <apsis/method/method_choice.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::stiff_set_table {
namespace {

using peers::stiff_limits;
using peers::stiff_outcome;

/// A run and its outcome.
struct contestant {
  std::string label;  ///< a method of Apsis, or empty
  std::function<stiff_outcome()> run;
  stiff_outcome measured = {};
  std::vector<double> seconds = {};  ///< seconds of one integration, for each turn
};

/// Runs a contestant so often that the clock resolves the time of a run.
void take_turn(contestant& one) {
  constexpr double enough = 5e-3;
  int runs = 0;
  const double begin = thread_seconds();
  do {
    one.measured = one.run();
    ++runs;
  } while (thread_seconds() - begin < enough && one.measured.failure.empty());
  one.seconds.push_back((thread_seconds() - begin) / runs);
}

/// Returns the methods of one step with implicit collisions, and extrapolated Euler steps.
std::vector<std::string> implicit_methods() {
  std::vector<std::string> names;
  for (const auto& name : method_names()) {
    const auto kind = find_method(name).kind;
    if (kind == method_kind::imex || kind == method_kind::implicit_only) names.push_back(name);
  }
  for (int order = 2; order <= 8; ++order) names.push_back(fmt::format("extrapolated-euler-{}", order));
  return names;
}

/// A problem at a tolerance.
class race {
 public:
  race(const stiff_problem_entry& problem, const stiff_limits& limits) : problem_(problem), limits_(limits) {}

  contestant by_apsis(const std::string& method, double seconds) const {
    stiff_limits limits = limits_;
    limits.seconds = std::min(limits.seconds, seconds);
    return {method, [this, method, limits] { return peers::run_apsis_stiff(problem_, method, limits); }};
  }

  /// Returns the method that reaches rtol within a digit in the least CPU time, otherwise the method with
  /// most digits. The search begins with the usual method. Every other method is stopped after twice its
  /// time, or after the time of the best method so far.
  std::string best_of(const std::vector<std::string>& methods) const {
    contestant first = by_apsis(usual(), limits_.seconds);
    take_turn(first);
    double least = std::min(limits_.seconds, 2.0 * first.seconds.front()), most = -1.0;
    std::string best = usual();
    bool reached = false;
    const auto compare = [&](const contestant& one) {
      if (!one.measured.failure.empty()) return;
      const double digits = digits_of(one), time = one.seconds.front();
      const bool reaches = digits >= -std::log10(limits_.rtol) - 1;
      if (reaches ? !reached || time < least : !reached && digits > most) best = one.label;
      if (reaches) least = std::min(least, time);
      reached = reached || reaches;
      most = std::max(most, digits);
    };
    compare(first);
    for (const auto& method : methods) {
      contestant one = by_apsis(method, least);
      take_turn(one);
      compare(one);
    }
    return best;
  }

  std::vector<contestant> all(const std::string& best) const {
    return {by_apsis(best, limits_.seconds),
            by_apsis(usual(), limits_.seconds),
            {"", [this] { return peers::run_cvode_stiff(problem_, limits_); }},
            {"", [this] { return peers::run_arkode_stiff(problem_, 4, limits_); }},
            {"", [this] { return peers::run_arkode_stiff(problem_, 5, limits_); }},
            {"", [this] { return peers::run_radau_stiff(problem_, limits_); }}};
  }

  /// Returns "method: digits; milliseconds; calls of Q + Jacobians".
  std::string cell(const contestant& one) const {
    const std::string name = one.label.empty() ? "" : "`" + one.label + "`: ";
    const auto& found = one.measured;
    if (found.failure == peers::too_slow) return name + fmt::format("> {:g} s", limits_.seconds);
    if (!found.failure.empty()) return name + "failed";
    return name + fmt::format("{:.1f}; {:.3g}; {} + {:.0f}", digits_of(one), 1e3 * median(one.seconds),
                              found.rates, std::ceil(found.jacobians));
  }

 private:
  /// Returns the method that "auto" chooses.
  std::string usual() const { return choose_method({.general = true, .tolerance = limits_.rtol}).method; }
  double digits_of(const contestant& one) const { return correct_digits(problem_, one.measured.u); }

  const stiff_problem_entry& problem_;
  stiff_limits limits_;
};

void add_row(result_table& result, const stiff_problem_entry& problem, double rtol,
             const std::vector<std::string>& methods, const settings& options) {
  const race here(problem, {.rtol = rtol, .seconds = options.quick ? 1.0 : 10.0});
  auto contestants = here.all(here.best_of(methods));
  double total = 0.0;
  for (auto& one : contestants) {
    take_turn(one);
    total += one.seconds.front();
  }
  constexpr double long_turn = 2.0;
  for (int turn = 1; turn < options.repeats && total < long_turn; ++turn)
    for (auto& one : contestants) take_turn(one);
  result.rows.push_back({problem.name, fmt::format("{:.0e}", rtol)});
  for (const auto& one : contestants) result.rows.back().emplace_back(here.cell(one));
}

result_table measure(const settings& options) {
  result_table result;
  result.title = "Stiff systems of the literature";
  result.note =
      "The problems are those of `src/apsis/verify/stiff`. All contestants have the same tolerances rtol "
      "and atol_i = rtol · size_i. A cell has three entries. The first is the number of correct digits. "
      "The second is the CPU time of a whole integration in milliseconds, set-up included. The third has "
      "calls of Q + evaluations of Q'. Products of Apsis count as parts of an evaluation. All "
      "contestants have the same Q and the same automatic derivatives. The best of Apsis is the method "
      "of one step that takes the least time among those that reach rtol within a digit. Without such a "
      "method it is the one with most digits. For the last three problems it is chosen from `ark-437`, "
      "`ark-548-2` and `extrapolated-euler-6`. Column `auto` has the method that `auto` chooses for the "
      "tolerance, without hindsight. CVODE uses BDF. ARKODE uses its default diagonally implicit methods "
      "of orders 4 and 5. Both have a dense or a band solver. Radau 5 has the control of RADAU5 with "
      "dense or sparse factorizations (bench/peers/radau_stiff.cpp). Turns of more than 2 s are measured "
      "once. A run is stopped after 10 s.";
  result.columns = {"problem", "rtol", "best of Apsis", "auto", "CVODE", "ARKODE 4", "ARKODE 5", "Radau 5"};
  const auto methods =
      options.quick ? std::vector<std::string>{"ark-436", "extrapolated-euler-5"} : implicit_methods();
  const std::vector<std::string> few{"ark-437", "ark-548-2", "extrapolated-euler-6"};  // for runs of seconds
  const auto tolerances = options.quick ? std::vector<double>{1e-4} : std::vector<double>{1e-4, 1e-6, 1e-8};
  for (const bool slow : {false, true})
    for (const auto* problem : stiff_problem_entries()) {
      if (problem->slow != slow || (options.quick && slow && problem->name != "brusselator")) continue;
      for (const double rtol : tolerances)
        add_row(result, *problem, rtol, slow && !options.quick ? few : methods, options);
    }
  return result;
}

const registered here({"stiff-set", "the stiff problems of the literature against other programs", measure});

}  // namespace
}  // namespace apsis::bench::stiff_set_table
