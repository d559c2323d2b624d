#include "triad.hpp"

#include <apsis/scheme/reconstruction_registry.hpp>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

namespace {

constexpr int cells = 64;

/// Measures a scheme of the registry on a pencil of rows of `width` values. The data are smooth and of widely
/// different magnitudes, like a velocity distribution. Each point reads one number and writes two: 24 bytes,
/// like an element of the triad.
void reconstruct(benchmark::State& state, const apsis::reconstruction_entry* entry) {
  const auto scheme = entry->make();
  const int width = static_cast<int>(state.range(0)), ghosts = scheme->ghost_width();
  const auto row = [width](int i) { return static_cast<std::size_t>(i) * static_cast<std::size_t>(width); };
  apsis::aligned_vector<double> u(row(cells + 2 * ghosts)), left(row(cells)), right(row(cells));
  for (int i = 0; i < cells + 2 * ghosts; ++i)
    for (int k = 0; k < width; ++k) {
      const double v = 30.0 * (k + 0.5) / width - 15.0;
      u[row(i) + static_cast<std::size_t>(k)] = (1.0 + 0.2 * std::sin(0.1 * i)) * std::exp(-v * v);
    }
  std::vector<const double*> rows;
  for (int i = 0; i < cells + 2 * ghosts; ++i) rows.push_back(u.data() + row(i));

  const auto start = std::chrono::steady_clock::now();
  for (auto _ : state) {
    scheme->edges(rows.data() + ghosts, cells, width, left.data(), right.data());
    benchmark::ClobberMemory();
  }
  const double points = static_cast<double>(state.iterations()) * cells * width;
  state.counters["of_triad"] = apsis::bench::fraction_of_triad(points, start, row(cells));
}

}  // namespace

int main(int argc, char** argv) {
  // This is not in a static object, because the entries are static objects of other files.
  for (const auto* entry : apsis::reconstruction_entries())
    benchmark::RegisterBenchmark(("reconstruction/" + entry->name).c_str(), reconstruct, entry)
        ->Arg(32)
        ->Arg(152);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
