// Speed of many small systems in lanes, compared with one after the other.
#include "measure/clock.hpp"
#include "measure/table.hpp"
#include "peers/ensembles.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::ensembles_table {
namespace {

using peers::ensemble_task;
using numbers = std::vector<double>;

/// An ensemble, its parameters and its solution.
class contest {
 public:
  contest(const ensemble_task& task, std::size_t systems) : task_(task) {
    for (std::size_t s = 0; s < systems; ++s) {
      start_.insert(start_.end(), task.start.begin(), task.start.end());
      const numbers own = task.parameters_of(s, systems);
      parameters_.insert(parameters_.end(), own.begin(), own.end());
    }
    exact_ = in_lanes("extrapolated-euler-8", 1e-11);
  }

  numbers in_lanes(const std::string& method, double rtol) const {
    numbers u = start_;
    task_.in_lanes(task_, method, rtol, u, parameters_);
    return u;
  }
  numbers by_cvode(double rtol) const {
    numbers u = start_;
    if (!task_.by_cvode(task_, rtol, u, parameters_)) u.assign(u.size(), NAN);
    return u;
  }
  /// Returns the seconds for a million systems in lanes, whose parameters fill the same range.
  double seconds_of_a_million(const std::string& method, double rtol) const {
    constexpr std::size_t million = 1000000;
    numbers u, parameters;
    for (std::size_t s = 0; s < million; ++s) {
      u.insert(u.end(), task_.start.begin(), task_.start.end());
      const numbers own = task_.parameters_of(s, million);
      parameters.insert(parameters.end(), own.begin(), own.end());
    }
    const double start = thread_seconds();
    task_.in_lanes(task_, method, rtol, u, parameters);
    return thread_seconds() - start;
  }
  /// Returns the largest error of all unknowns, relative to |u_i| + size_i.
  double error(const numbers& u) const {
    double largest = 0.0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      const double one = std::abs(u[i] - exact_[i]) / (std::abs(exact_[i]) + task_.sizes[i % task_.unknowns]);
      if (!(one <= largest)) largest = one;
    }
    return largest;
  }
  /// Returns the largest tolerance 10^{−k/2} of CVODE with at most this error.
  double tolerance_of_cvode(double most) const {
    for (int k = 4; k <= 26; ++k)
      if (error(by_cvode(std::pow(10.0, -0.5 * k))) <= most) return std::pow(10.0, -0.5 * k);
    return 1e-13;
  }

 private:
  const ensemble_task& task_;
  numbers start_, parameters_, exact_;
};

void add_rows(result_table& result, const ensemble_task& task, const settings& options) {
  const std::size_t systems = options.quick ? 8 : 256;
  const contest here(task, systems);
  const auto microseconds = [&](double seconds) { return 1e6 * seconds / static_cast<double>(systems); };
  for (const std::string& method : {peers::linear_steps, std::string("ark-436")})
    for (const double rtol : {1e-4, 1e-6, 1e-8}) {
      if (options.quick && rtol < 1e-5) continue;
      const double error = here.error(here.in_lanes(method, rtol)), equal = here.tolerance_of_cvode(error);
      const auto seconds = in_turns(
          {[&] { here.in_lanes(method, rtol); }, [&] { here.by_cvode(rtol); }, [&] { here.by_cvode(equal); }},
          options.quick ? 1 : options.repeats);
      result.rows.push_back({task.name, method, fmt::format("{:.0e}", rtol), fmt::format("{:.1e}", error),
                             microseconds(median(seconds[0])),
                             options.quick ? 0.0 : here.seconds_of_a_million(method, rtol),
                             fmt::format("{:.1e}", here.error(here.by_cvode(rtol))),
                             fmt::format("{:.1f}", median_ratio(seconds, 1, 0)),
                             fmt::format("{:.1f}", median_ratio(seconds, 2, 0))});
    }
}

result_table measure(const settings& options) {
  result_table result;
  result.title = "Ensembles";
  result.note =
      "The table shows ensembles of 256 systems whose parameters vary by 30 percent, on one core. "
      "`integrate_ensemble` integrates eight systems in lanes and is compiled with -march=native. CVODE "
      "integrates one system after the other with exact Jacobians. Times µs are those of one system in "
      "lanes. Column `10⁶` has the seconds for a million systems in lanes. "
      "Errors are the largest of all unknowns, relative to |u_i| + size_i, where atol_i = rtol · size_i. "
      "The ratios are the time of CVODE divided by that of lanes. Column `same rtol` compares runs with "
      "the same rtol. In column `same error` CVODE has the largest tolerance whose error is as small.";
  result.columns = {"problem", "method",         "rtol",      "error",     "µs",
                    "10⁶",     "error of CVODE", "same rtol", "same error"};
  add_rows(result, peers::robertson_ensemble(), options);
  add_rows(result, peers::ode_model_ensemble(), options);
  return result;
}

const registered here({"ensembles", "many small systems in lanes against CVODE in a loop", measure});

}  // namespace
}  // namespace apsis::bench::ensembles_table
