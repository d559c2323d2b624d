// Throughput in one, two and three dimensions of space and velocity, on states beyond the caches.
#include "../cached_sweeps.hpp"
#include "../clock.hpp"
#include "../mixed_step.hpp"
#include "../table.hpp"

#include <apsis/exec/ceilings.hpp>
#include <apsis/exec/parallel.hpp>

#include <algorithm>
#include <deque>
#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::dimensions_table {
namespace {

/// A problem of the table.
struct problem_size {
  std::string name, equilibria, cells;
  int dimensions;
  double max;  ///< largest velocity
  int points;  ///< velocities of each direction
};

/// Returns problems with states of 50 to 75 MB. The moments of Maxwellians are exact only if the velocities
/// are dense and reach far. Otherwise Newton's method finds the equilibria.
std::vector<problem_size> sizes(bool with_closed_form, bool quick) {
  if (quick) return {{"1D1V", "Newton", "[60]", 1, 6, 150}, {"2D2V", "Newton", "[16, 12]", 2, 6, 12}};
  std::vector<problem_size> all = {{"1D1V", "Newton", "[40000]", 1, 6, 150},
                                   {"2D2V", "Newton", "[96, 96]", 2, 6, 24},
                                   {"3D3V", "Newton", "[16, 16, 16]", 3, 6, 12}};
  if (with_closed_form)
    all.insert(all.end(), {{"1D1V", "closed form", "[40000]", 1, 9, 150},
                           {"2D2V", "closed form", "[96, 96]", 2, 9, 26},
                           {"3D3V", "closed form", "[8, 8, 8]", 3, 9, 26}});
  return all;
}

case_config case_of(const problem_size& of) {
  const std::vector<std::string> unit = {"[[0, 1]]", "[[0, 1], [0, 1]]", "[[0, 1], [0, 1], [0, 1]]"},
                                 rest = {"[0]", "[0, 0]", "[0, 0, 0]"};
  const auto k = static_cast<std::size_t>(of.dimensions - 1);
  return parse_case(
      fmt::format(
          "[model]\nname = \"bgk\"\nepsilon = 0.01\n[initial]\nrho = \"1 + 0.2*sin(2*pi*x)\"\nu = {}\n"
          "T = 1\n[space]\ncells = {}\ndomain = {}\nformulation = \"finite-difference\"\n"
          "limiter = \"positivity\"\n[velocity]\nmax = {}\npoints = {}\n[time]\nmethod = "
          "\"md-imex-6-3\"\nsafety = 1\nend = 0.1\n",
          rest[k], of.cells, unit[k], of.max, of.points),
      "waves.toml");
}

/// Returns how often a turn evaluates the sweeps in the cache.
int evaluations(const problem_size& of, const settings& options) {
  return options.quick ? 1 : 20000 / of.dimensions;
}

/// Adds the rows for a number of threads. Only one thread also has the sizes with equilibria in closed form.
void measure_on(int n, const settings& options, result_table& result) {
  set_threads(n);
  const auto all_sizes = sizes(n == 1, options.quick);
  std::deque<mixed_step> steps;
  std::deque<std::vector<cached_sweeps>> sweeps;  // sweeps of each thread
  std::vector<sweep_work> swept;
  std::vector<job> jobs;
  for (const problem_size& each : all_sizes) {
    const case_config config = case_of(each);
    mixed_step& step = steps.emplace_back(config);
    swept.push_back(step.count_sweeps());
    auto& sweep = sweeps.emplace_back();
    for (int k = 0; k < n; ++k) sweep.emplace_back(config, swept.back().accumulators);
    const int times = evaluations(each, options);
    jobs.push_back([&step] { step.take(1); });
    jobs.push_back([&sweep, times] {
      parallel_for(threads(), [&](int k) { sweep[static_cast<std::size_t>(k)].evaluate(times); });
    });
  }
  const double count = options.quick ? 1e5 : 1e7;
  const std::size_t part = steps.front().numbers() / static_cast<std::size_t>(n);
  jobs.push_back([count] { parallel_for(threads(), [count](int) { seconds_of_multiply_adds(count); }); });
  std::vector<double> rates(static_cast<std::size_t>(n)), triads;
  jobs.push_back([&] {
    parallel_for(threads(),
                 [&](int k) { rates[static_cast<std::size_t>(k)] = triad_bytes_per_second(part); });
    triads.push_back(std::accumulate(rates.begin(), rates.end(), 0.0));
  });
  const auto seconds = in_turns(jobs, options.repeats);
  const std::size_t multiply_adds = jobs.size() - 2;
  for (std::size_t k = 0; k < all_sizes.size(); ++k) {
    const auto work = steps[k].count_work();
    const double points = steps[k].point_stages(), time = median(seconds[2 * k]);
    const double ratio = median_ratio(seconds, 0, 2 * k) * points / steps[0].point_stages();
    const double evaluated = n * evaluations(all_sizes[k], options) * sweeps[k].front().numbers();
    const double in_cache = swept[k].numbers / evaluated * median_ratio(seconds, 2 * k + 1, 2 * k);
    result.rows.push_back(
        {all_sizes[k].name, all_sizes[k].equilibria, n, points / time, fmt::format("{:.2f}", ratio),
         fmt::format("{:.1f}", work.operations / points), fmt::format("{:.1f}", work.bytes / points),
         fmt::format("{:.0f} %",
                     100.0 * work.operations / time * median(seconds[multiply_adds]) / (n * count)),
         fmt::format("{:.0f} %", 100.0 * work.bytes / time / median(triads)),
         fmt::format("{:.0f} %", 100.0 * in_cache), fmt::format("{:.0f} %", 100.0 * swept[k].share)});
  }
}

result_table measure(const settings& options) {
  result_table result;
  result.title = "Dimensions of space and velocity";
  result.note =
      "The table shows point·stages per second of md-imex-6-3 with finite differences, the limiter and "
      "BGK. States have 50 to 75 MB. The ratio is that to the first row in the same turns. Equilibria "
      "are Maxwellians in closed form where the velocities are dense and reach far enough for exact "
      "moments. Newton's method finds all other equilibria. A stage of D dimensions has D sweeps. "
      "Operations and bytes are those of a point·stage. Operations are arithmetic instructions per "
      "number, with those that neighbouring boxes repeat. Bytes are the compulsory memory traffic. The "
      "next columns are fractions of three ceilings of the machine in the same turn. The first ceiling "
      "is that of multiply–adds in registers. The second is the triad on arrays of the length of a "
      "state. The third is that of the kernels of the D sweeps on data in the first-level cache, without "
      "collisions. The last column is the share of the sweeps in the time of a step. Collisions take the "
      "rest.";
  result.columns = {
      "space × velocity", "equilibria", "threads",          "point·stages/s", "ratio",
      "operations",       "bytes",      "of multiply–adds", "of triad",       "of sweeps in cache",
      "time in sweeps"};
  for (const int n : {1, 2}) measure_on(n, options, result);
  set_threads(1);
  return result;
}

const registered here({"dimensions", "speed in one, two and three dimensions", measure});

}  // namespace
}  // namespace apsis::bench::dimensions_table
