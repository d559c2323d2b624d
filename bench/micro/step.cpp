#include "triad.hpp"

#include <apsis/config/case.hpp>
#include <apsis/integrate/schedule.hpp>
#include <apsis/method/method.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <string>

#include <benchmark/benchmark.h>

namespace {

/// Measures steps of a built-in case, with promises checked as in every run. A stage must at least read a
/// state, read an accumulator and write it: 24 bytes per point, like an element of the triad.
void step(benchmark::State& state, const std::string& name, const std::string& method) {
  apsis::simulation run(apsis::load_case(name, {"time.method=" + method, "time.end=1e6"}));
  const auto points = static_cast<double>(run.mesh().size()) * run.setup().equation->components();
  const auto stages = static_cast<double>(apsis::find_method(method).stages());
  const auto start = std::chrono::steady_clock::now();
  for (auto _ : state) run.advance();
  state.counters["of_triad"] = apsis::bench::fraction_of_triad(
      points * stages * static_cast<double>(state.iterations()), start, static_cast<std::size_t>(points));
}

BENCHMARK_CAPTURE(step, finite_volume_2nd, "paper/bgk-mixed", "md-imex-3-2")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(step, finite_volume_3rd, "paper/bgk-mixed", "md-imex-6-3")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(step, finite_difference_2nd, "paper/bgk-mixed-fd", "md-imex-3-2")
    ->Unit(benchmark::kMillisecond);

}  // namespace
