// Iterations to the steady state, and the time that they save compared with steps in time.
#include "../clock.hpp"
#include "../table.hpp"

#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/run/simulation.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::steady_table {
namespace {

constexpr double tolerance = 1e-8;

struct flow {
  std::string name;
  std::vector<std::string> keys;
  bool varies = true;  ///< whether parameters.delta varies
  std::string mesh = "";
  double limit = 10.0;  ///< CPU seconds of the run in time
};

std::vector<flow> all_flows(bool quick) {
  if (quick) return {{"gas/couette", {"space.cells=8"}}};
  return {{"gas/couette", {}},
          {"gas/fourier", {}},
          {"gas/poiseuille", {}},
          {"gas/kramers", {}, false},
          {"gas/micro-channel", {}, false},
          {"gas/evaporation", {}, false},
          {"gas/cavity", {}},
          {"gas/thermal-cavity", {}},
          {"gas/enclosure", {}},
          {"gas/transpiration", {}},
          {"gas/duct", {}},
          {"gas/step", {}, false},
          {"gas/cavity", {"space.cells=[64, 64]"}, true, ", 64 × 64 cells", 60.0}};
}

/// Starts a run. Both modes have upwind5, so that they solve the same equations.
simulation start(const flow& of, const std::string& delta, const std::string& mode) {
  std::vector<std::string> keys = of.keys;
  if (of.varies) keys.push_back("parameters.delta=" + delta);
  keys.insert(keys.end(), {"space.reconstruction=upwind5", "space.limiter=none", mode, "output.every=0"});
  if (mode.starts_with("time")) keys.emplace_back("time.end=1e9");
  return simulation(load_case(of.name, keys));
}

struct solved {
  long iterations = -1;
  double seconds = std::numeric_limits<double>::quiet_NaN();
};

solved solve(const flow& of, const std::string& delta) {
  try {
    simulation run = start(of, delta, fmt::format("steady.tolerance={}", tolerance));
    while (!run.finished()) run.advance();
    return {run.step(), run.summary().cpu_s};
  } catch (const numerical_error&) {
    return {};
  }
}

struct marched {
  double seconds;  ///< CPU seconds in which the rate of change falls to the tolerance
  bool complete;   ///< false if extrapolated from the decay of the second half
};

marched march(const flow& of, const std::string& delta, double limit) {
  simulation run = start(of, delta, "time.steady=1e-300");
  std::vector<double> seconds, rates;
  double first = 0.0;
  while (run.summary().cpu_s < limit) {
    const double rate = run.advance().change;
    first = std::max(first, rate);
    seconds.push_back(run.summary().cpu_s);
    rates.push_back(std::log(rate / first));
    if (rate <= tolerance * first) return {seconds.back(), true};
  }
  const std::size_t last = rates.size() - 1, half = last / 2;
  const double slope = (rates[last] - rates[half]) / (seconds[last] - seconds[half]);
  const double left = (std::log(tolerance) - rates[last]) / slope;
  return {left > 0.0 ? seconds[last] + left : std::numeric_limits<double>::infinity(), false};
}

result_table measure(const settings& options) {
  result_table result;
  result.title = "Steady states";
  result.note =
      "Iterations of `[steady]` end with a residual and a change of the moments of 1e-8. "
      "CPU times are those of one thread. "
      "They are medians of a run before the steps in time and others after it. "
      "Steps in time are those of the shipped method at its longest step. "
      "They end when the rate of change has fallen to 1e-8 of its largest value. "
      "\"≈\" marks times extrapolated from the decay within 10 s (60 s with 64 × 64 cells). "
      "Both use upwind5 without limiter, and start from the data of the case.";
  result.columns = {"flow", "δ", "iterations", "CPU time (s)", "in time (s)", "ratio"};
  set_threads(1);
  const std::vector<std::string> deltas =
      options.quick ? std::vector<std::string>{"1"}
                    : std::vector<std::string>{"0.01", "0.1", "1", "10", "100", "1000"};
  for (const flow& of : all_flows(options.quick))
    for (const std::string& delta : of.varies ? deltas : std::vector<std::string>{"as shipped"}) {
      solved by_iterations = solve(of, delta);
      const marched in_time = march(of, delta, options.quick ? 0.1 : of.limit);
      std::vector<double> seconds{by_iterations.seconds};
      for (int turn = 1; turn < (options.quick ? 1 : options.repeats); ++turn)
        seconds.push_back(solve(of, delta).seconds);
      by_iterations.seconds = median(std::move(seconds));
      const bool known = std::isfinite(in_time.seconds);
      result.rows.push_back(
          {of.name + of.mesh, delta,
           by_iterations.iterations < 0 ? nlohmann::json("none") : nlohmann::json(by_iterations.iterations),
           fmt::format("{:.2g}", by_iterations.seconds),
           known ? fmt::format("{}{:.2g}", in_time.complete ? "" : "≈ ", in_time.seconds) : "—",
           known ? fmt::format("{:.2g}", in_time.seconds / by_iterations.seconds) : "—"});
    }
  return result;
}

const registered here({"steady", "iterations to steady states, compared with steps in time", measure});

}  // namespace
}  // namespace apsis::bench::steady_table
