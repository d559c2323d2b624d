// Throughput in one, two and three dimensions of space and velocity, on states beyond the caches.
#include "../clock.hpp"
#include "../mixed_step.hpp"
#include "../table.hpp"

#include <apsis/exec/ceilings.hpp>
#include <apsis/exec/parallel.hpp>

#include <algorithm>
#include <deque>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::dimensions_table {
namespace {

/// The mesh and the velocities of D dimensions.
struct extent {
  std::string cells, points;
};

case_config case_of(int dimensions, const settings& options) {
  const std::vector<extent> large = {{"[40000]", "150"}, {"[96, 96]", "24"}, {"[16, 16, 16]", "12"}},
                            small = {{"[60]", "150"}, {"[16, 12]", "12"}, {"[8, 7, 7]", "8"}};
  const extent& of = (options.quick ? small : large)[static_cast<std::size_t>(dimensions - 1)];
  const std::vector<std::string> unit = {"[[0, 1]]", "[[0, 1], [0, 1]]", "[[0, 1], [0, 1], [0, 1]]"},
                                 rest = {"[0]", "[0, 0]", "[0, 0, 0]"};
  const auto k = static_cast<std::size_t>(dimensions - 1);
  return parse_case(
      fmt::format(
          "[model]\nname = \"bgk\"\nepsilon = 0.01\n[initial]\nrho = \"1 + 0.2*sin(2*pi*x)\"\nu = {}\n"
          "T = 1\n[space]\ncells = {}\ndomain = {}\nformulation = \"finite-difference\"\n"
          "limiter = \"positivity\"\n[velocity]\nmax = 6\npoints = {}\n[time]\nmethod = "
          "\"md-imex-6-3\"\nsafety = 1\nend = 0.1\n",
          rest[k], of.cells, unit[k], of.points),
      "waves.toml");
}

result_table measure(const settings& options) {
  result_table result;
  result.title = "Dimensions of space and velocity";
  result.note =
      "Point·stages per second of md-imex-6-3 with finite differences and the limiter, BGK, states of about "
      "50 "
      "MB each. The ratio is that to one dimension in the same turns. A stage of D dimensions has D sweeps: "
      "operations (arithmetic instructions per number) and bytes (compulsory memory traffic) are those of a "
      "point·stage, and the fractions those of the ceilings of the machine in the same turn: multiply–adds "
      "in "
      "registers, and the triad on arrays of the length of a state.";
  result.columns = {"space × velocity", "threads", "point·stages/s",   "ratio",
                    "operations",       "bytes",   "of multiply–adds", "of triad"};
  for (const int n : {1, 2}) {
    set_threads(n);
    std::deque<mixed_step> all;
    for (const int dimensions : {1, 2, 3}) all.emplace_back(case_of(dimensions, options));
    std::vector<job> jobs;
    for (mixed_step& one : all) jobs.push_back([&one] { one.take(1); });
    const double count = options.quick ? 1e5 : 1e7;
    const std::size_t part = all.front().numbers() / static_cast<std::size_t>(n);
    jobs.push_back([count] { parallel_for(threads(), [count](int) { seconds_of_multiply_adds(count); }); });
    std::vector<double> rates(static_cast<std::size_t>(n)), triads;
    jobs.push_back([&] {
      parallel_for(threads(),
                   [&](int k) { rates[static_cast<std::size_t>(k)] = triad_bytes_per_second(part); });
      triads.push_back(0.0);
      for (const double rate : rates) triads.back() += rate;
    });
    const auto seconds = in_turns(jobs, options.repeats);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto each = all[k].count_work();
      const double points = all[k].point_stages(), time = median(seconds[k]);
      const double ratio = median_ratio(seconds, 0, k) * points / all[0].point_stages();
      result.rows.push_back(
          {fmt::format("{}D{}V", k + 1, k + 1), n, points / time, fmt::format("{:.2f}", ratio),
           fmt::format("{:.1f}", each.operations / points), fmt::format("{:.1f}", each.bytes / points),
           fmt::format("{:.0f} %", 100.0 * each.operations / time * median(seconds[3]) / (n * count)),
           fmt::format("{:.0f} %", 100.0 * each.bytes / time / median(triads))});
    }
  }
  set_threads(1);
  return result;
}

const registered here({"dimensions", "speed in one, two and three dimensions", measure});

}  // namespace
}  // namespace apsis::bench::dimensions_table
