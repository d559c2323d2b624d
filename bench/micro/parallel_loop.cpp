// Parallel loops over blocks of cells: the thread team of the library compared with OpenMP, and with TBB if
// available. Bodies last as long as a block of a sweep. "of_ceiling" is the speed relative to that of the
// bodies alone on as many processors.
#include <apsis/exec/parallel.hpp>

#include <chrono>
#include <cmath>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>
#ifdef APSIS_BENCH_TBB
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#endif
#ifdef _OPENMP
#include <omp.h>
#endif

namespace {

/// Does about 1 ns of dependent work per count, so that a body lasts equally long wherever it runs.
double work(double x, int count) {
  for (int k = 0; k < count; ++k) x = 0.5 * x + 0.25;
  return x;
}

struct loop {
  int blocks, nanoseconds;
  std::vector<double> results = std::vector<double>(static_cast<std::size_t>(blocks));
  void operator()(int k) { results[static_cast<std::size_t>(k)] = work(k, nanoseconds); }
};

constexpr int threads = 2;

/// Runs `region(loop)` as one parallel region per iteration, and compares with the bodies one after the
/// other.
template <class Region>
void measure(benchmark::State& state, const Region& region) {
  loop body{static_cast<int>(state.range(0)), static_cast<int>(state.range(1))};
  const auto clock = [] { return std::chrono::steady_clock::now(); };
  std::chrono::duration<double> alone{}, together{};
  for (auto _ : state) {
    const auto a = clock();
    for (int k = 0; k < body.blocks; ++k) body(k);
    const auto b = clock();
    region(body);
    const auto c = clock();
    alone += b - a;
    together += c - b;
    state.SetIterationTime(std::chrono::duration<double>(c - b).count());
    benchmark::DoNotOptimize(body.results.data());
  }
  state.counters["of_ceiling"] = alone.count() / threads / together.count();
}

void team(benchmark::State& state) {
  apsis::set_threads(threads);
  measure(state, [](loop& body) { apsis::parallel_for(body.blocks, [&](int k) { body(k); }); });
}

#ifdef APSIS_BENCH_TBB
template <class Partitioner>
void tbb_loop(benchmark::State& state) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  Partitioner partitioner;
  measure(state,
          [&](loop& body) { tbb::parallel_for(0, body.blocks, [&](int k) { body(k); }, partitioner); });
}
void tbb_static(benchmark::State& state) {
  tbb_loop<tbb::static_partitioner>(state);
}
void tbb_affinity(benchmark::State& state) {
  tbb_loop<tbb::affinity_partitioner>(state);
}
#endif

#ifdef _OPENMP
void openmp_static(benchmark::State& state) {
  measure(state, [](loop& body) {
#pragma omp parallel for schedule(static) num_threads(threads)
    for (int k = 0; k < body.blocks; ++k) body(k);
  });
}
void openmp_guided(benchmark::State& state) {
  measure(state, [](loop& body) {
#pragma omp parallel for schedule(guided) num_threads(threads)
    for (int k = 0; k < body.blocks; ++k) body(k);
  });
}
#endif

/// Sets the blocks of a region and the nanoseconds of a block, as for 40, 400 and 4000 cells of the
/// paper's problem.
void sizes(benchmark::internal::Benchmark* of) {
  of->Args({4, 5000})->Args({16, 10000})->Args({160, 10000})->UseManualTime();
}

BENCHMARK(team)->Apply(sizes);
#ifdef APSIS_BENCH_TBB
BENCHMARK(tbb_static)->Apply(sizes);
BENCHMARK(tbb_affinity)->Apply(sizes);
#endif
#ifdef _OPENMP
BENCHMARK(openmp_static)->Apply(sizes);
BENCHMARK(openmp_guided)->Apply(sizes);
#endif

}  // namespace
