#include "triad.hpp"

#include <benchmark/benchmark.h>

namespace {

/// Measures bytes per second for an array length, the ceiling of the other benchmarks.
void triad(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  double bytes_per_second = 0.0;
  for (auto _ : state) bytes_per_second = apsis::bench::triad_bytes_per_second(count);
  state.counters["bytes_per_second"] = bytes_per_second;
}

BENCHMARK(triad)->Arg(1 << 9)->Arg(1 << 13)->Arg(1 << 21)->Unit(benchmark::kMillisecond);

}  // namespace
