// Several threads evaluate formulas of a case. The pool of parsers is compared with one parser behind a lock,
// and with a parser for each thread, the ceiling.
#include <apsis/model/expression.hpp>

#include <memory>
#include <mutex>
#include <vector>

#include <benchmark/benchmark.h>

namespace {

const char* const flux = "u^2/(u^2 + 0.5*(1 - u)^2)";
const apsis::formula_kind in_u{{"u"}, false};

/// All threads evaluate one expression, as the cells of a run do.
void shared_expression(benchmark::State& state) {
  static const apsis::expression f(flux, {}, in_u);
  double u = 0.1 * (state.thread_index() + 1);
  for (auto _ : state) benchmark::DoNotOptimize(u = 0.999 * u + 0.001 * f.value(u));
}
BENCHMARK(shared_expression)->ThreadRange(1, 2)->UseRealTime();

/// All threads evaluate one expression behind a lock.
void locked_expression(benchmark::State& state) {
  static const apsis::expression f(flux, {}, in_u);
  static std::mutex mutex;
  double u = 0.1 * (state.thread_index() + 1);
  for (auto _ : state) {
    const std::lock_guard lock(mutex);
    benchmark::DoNotOptimize(u = 0.999 * u + 0.001 * f.value(u));
  }
}
BENCHMARK(locked_expression)->ThreadRange(1, 2)->UseRealTime();

/// Every thread evaluates an expression of its own.
void own_expression(benchmark::State& state) {
  const apsis::expression f(flux, {}, in_u);
  double u = 0.1 * (state.thread_index() + 1);
  for (auto _ : state) benchmark::DoNotOptimize(u = 0.999 * u + 0.001 * f.value(u));
}
BENCHMARK(own_expression)->ThreadRange(1, 2)->UseRealTime();

}  // namespace
