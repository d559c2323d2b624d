// The methods without second derivatives on the stiff problems of the literature. The automatic choice of a
// method for general stiff systems follows from this measurement.
#include "measure/clock.hpp"
#include "measure/table.hpp"
#include "peers/stiff_set.hpp"

#include <apsis/method/certificate.hpp>
#include <apsis/method/method.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::stiff_methods_table {
namespace {

using peers::stiff_limits;

/// Time, relative to the best, of a method that does not reach a tolerance within a digit, or takes longer.
constexpr double missing = 30.0;

/// Returns the methods of order 3 and more with implicit collisions and without second derivatives, whose
/// stages share a derivative. Extrapolated Euler steps follow.
std::vector<std::string> competitors(bool quick) {
  if (quick) return {"ark-437", "extrapolated-euler-4"};
  std::vector<std::string> names;
  for (const auto& name : method_names()) {
    const method& m = find_method(name);
    const auto weights = m.coefficients<double>().ddot;
    const bool first_derivatives =
        std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0.0; });
    if (m.kind == method_kind::imex && first_derivatives && find_certificate(name).order >= 3)
      names.push_back(name);
  }
  for (int order = 3; order <= 8; ++order) names.push_back(fmt::format("extrapolated-euler-{}", order));
  return names;
}

/// Returns the CPU seconds of an integration; nothing if it does not reach rtol within a digit in
/// `most` seconds.
std::optional<double> seconds_of(const stiff_problem_entry& problem, const std::string& method, double rtol,
                                 double most, int repeats) {
  constexpr double long_run = 0.1;
  std::vector<double> seconds;
  do {
    const double begin = thread_seconds();
    const auto found = peers::run_apsis_stiff(problem, method, stiff_limits{.rtol = rtol, .seconds = most});
    seconds.push_back(thread_seconds() - begin);
    if (!found.failure.empty() || !(correct_digits(problem, found.u) >= -std::log10(rtol) - 1.0))
      return std::nullopt;
  } while (static_cast<int>(seconds.size()) < repeats && seconds.front() < long_run);
  return median(seconds);
}

/// The result of a method at a tolerance: ln of its time over that of the best method, summed over problems.
struct score {
  double log_ratios = 0.0;
  int reached = 0;
};

/// Adds the scores of a problem at a tolerance. Returns false if no method reaches it.
bool add_problem(const stiff_problem_entry& problem, double rtol, const settings& options,
                 const std::vector<std::string>& methods, std::map<std::string, score>& scores) {
  double best = options.quick ? 1.0 / missing : 10.0 / missing;
  std::map<std::string, double> times;
  for (const auto& method : methods) {
    const auto time = seconds_of(problem, method, rtol, missing * best, options.repeats);
    if (!time) continue;
    times[method] = *time;
    best = times.size() == 1 ? *time : std::min(best, *time);
  }
  if (times.empty()) return false;
  for (const auto& method : methods) {
    const auto found = times.find(method);
    scores[method].log_ratios += std::log(found == times.end() ? missing : found->second / best);
    scores[method].reached += found == times.end() ? 0 : 1;
  }
  return true;
}

result_table measure(const settings& options) {
  result_table result;
  result.title = "Methods for general stiff systems";
  result.note =
      "The table uses the problems of the table above, at the same tolerances. A cell has the geometric "
      "mean of the CPU time relative to the best method of each problem. Brackets contain the number of "
      "problems solved within a digit of the tolerance. A problem that is not solved counts as 30. The "
      "last column is the mean over all problems and tolerances. The methods are those of order 3 and "
      "more without second derivatives. Their stages share a derivative of Q in a step.";
  const auto methods = competitors(options.quick);
  const auto tolerances = options.quick ? std::vector<double>{1e-4} : std::vector<double>{1e-4, 1e-6, 1e-8};
  result.columns = {"method"};
  std::map<std::string, double> log_means;
  std::map<std::string, std::vector<std::string>> cells;
  int all = 0;
  for (const double rtol : tolerances) {
    std::map<std::string, score> scores;
    int problems = 0;
    for (const auto* problem : stiff_problem_entries())
      if (!options.quick || !problem->slow)
        problems += add_problem(*problem, rtol, options, methods, scores) ? 1 : 0;
    for (const auto& method : methods) {
      const score& of = scores[method];
      log_means[method] += of.log_ratios;
      cells[method].push_back(
          fmt::format("{:.2f} ({})", std::exp(of.log_ratios / std::max(problems, 1)), of.reached));
    }
    all += problems;
    result.columns.push_back(fmt::format("{:.0e}, of {}", rtol, problems));
  }
  result.columns.emplace_back("mean");
  for (const auto& method : methods) {
    result.rows.push_back({method});
    for (const auto& cell : cells[method]) result.rows.back().emplace_back(cell);
    result.rows.back().emplace_back(fmt::format("{:.2f}", std::exp(log_means[method] / std::max(all, 1))));
  }
  return result;
}

const registered here({"stiff-methods", "methods for general stiff systems, which auto chooses from",
                       measure});

}  // namespace
}  // namespace apsis::bench::stiff_methods_table
