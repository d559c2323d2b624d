// Efficiency of runs on several processes: `mpirun -n 2 apsis_measure`.
#include "../clock.hpp"
#include "../table.hpp"

#include <apsis/boundary/domain.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis::bench::processes_table {
namespace {

using processes_pointer = std::shared_ptr<communicator>;

/// A periodic gas with `first` cells in the first direction and `others` in each other direction.
struct gas {
  std::string name;
  int dimensions, first, others, points;
};

case_config case_of(const gas& of) {
  const auto directions = static_cast<std::size_t>(of.dimensions);
  std::vector<int> cells(directions, of.others);
  cells.front() = of.first;
  const std::vector<std::string> domain(directions, "[0, 1]"), rest(directions, "0");
  return parse_case(
      fmt::format(
          "[model]\nname = \"bgk\"\nepsilon = 0.01\n[initial]\nrho = \"1 + 0.2*sin(2*pi*x)\"\nu = [{}]\nT = "
          "1\n"
          "[space]\ncells = [{}]\ndomain = [{}]\nformulation = \"finite-difference\"\nlimiter = "
          "\"positivity\"\n"
          "[velocity]\nmax = 6\npoints = {}\n[time]\nmethod = \"md-imex-6-3\"\nsafety = 0.9\nend = 100.0\n",
          fmt::join(rest, ", "), fmt::join(cells, ", "), fmt::join(domain, ", "), of.points),
      "waves.toml");
}

/// The processes that take a step.
enum class workers {
  root,        ///< the root alone, with the whole mesh
  each_alone,  ///< every process, with a mesh of its own
  together     ///< all processes, which share the mesh
};

/// Steps of a run on one or all processes; the others sleep meanwhile.
class timed_run {
 public:
  timed_run(const gas& of, const processes_pointer& all, workers who)
      : all_(all), takes_part_(who != workers::root || all->is_root()) {
    if (takes_part_)
      run_ = std::make_unique<simulation>(case_of(of), state_source(),
                                          who == workers::together ? all : single_process());
    take();
  }
  /// Takes a step and returns its wall-clock seconds on the slowest process.
  double take() {
    wait_asleep();
    const double start = wall_seconds();
    if (run_) run_->advance();
    std::array<double, 1> fastest = {takes_part_ ? start - wall_seconds() : 0.0};
    wait_asleep();
    all_->lowest(fastest);
    return -fastest[0];
  }
  const simulation* run() const { return run_.get(); }

 private:
  /// Waits for all processes without a busy loop, which would disturb the others.
  void wait_asleep() {
    if (!all_->all_call_within(3600.0)) throw std::runtime_error("a process did not arrive within an hour");
  }

  processes_pointer all_;
  bool takes_part_;
  std::unique_ptr<simulation> run_;
};

/// Messages of a step.
struct exchanged {
  double messages, bytes, reductions;  ///< messages, bytes and reductions of this process
  double waited,                       ///< seconds of packing and waiting in a step
      blocking;                        ///< seconds of the same exchanges without other work
};

exchanged count_exchanges(const gas& of, const processes_pointer& all) {
  simulation run(case_of(of), {}, all);
  run.advance();
  const communication_count before = all->count();
  run.advance();
  exchanged result{};
  result.messages = static_cast<double>(all->count().messages - before.messages);
  result.bytes = static_cast<double>(all->count().bytes - before.bytes);
  result.reductions = static_cast<double>(all->count().reductions - before.reductions);
  // A process that is faster than the others waits for them, so that the shortest time is that of
  // the messages.
  std::vector<double> waits;
  for (int step = 0; step < 5; ++step) {
    profile::start();
    run.advance();
    profile::stop();
    std::array<double, 1> shortest = {0.0};
    for (const auto& kernel : profile::read())
      if (kernel.which == kernel::halo) shortest[0] = kernel.seconds;
    all->lowest(shortest);
    waits.push_back(shortest[0]);
  }
  result.waited = median(waits);

  const run_setup setup(case_of(of), all);
  const field u = setup.initial_state();
  const auto made = setup.builder().make_space();
  domain& space = *made;
  constexpr int width = 4;  // halo of WENO with the limiter
  space.reserve(u.components(), width);
  const long bytes_before = all->count().bytes;
  space.exchange(u);
  const double times = result.bytes / static_cast<double>(all->count().bytes - bytes_before);
  std::vector<double> seconds;
  for (int repetition = 0; repetition < 7; ++repetition) {
    const double start = wall_seconds();
    space.exchange(u);
    seconds.push_back(wall_seconds() - start);
  }
  result.blocking = times * median(seconds);
  return result;
}

/// Returns the seconds in which processes 0 and 1 send each other `count` numbers; 0 on other processes.
double one_way(const processes_pointer& all, std::size_t count, int times) {
  if (all->rank() > 1) return 0.0;
  std::vector<double> mine(count, 1.0), theirs(count);
  const int other = 1 - all->rank();
  const std::vector<message> sent = {{other, mine}}, received = {{other, theirs}};
  const double start = wall_seconds();
  for (int k = 0; k < times; ++k) {
    all->begin_exchange(sent, received);
    all->finish_exchange();
  }
  return (wall_seconds() - start) / times;
}

/// Measures latency and bandwidth between two processes, and the time of a reduction.
void measure_messages(const settings& options, result_table& result) {
  const auto& all = options.processes;
  const int times = options.quick ? 10 : 2000;
  std::vector<double> shortest, longest, sums;
  constexpr std::size_t numbers = 1 << 20;
  for (int repetition = 0; repetition <= options.repeats; ++repetition) {
    shortest.push_back(one_way(all, 1, times));
    longest.push_back(one_way(all, numbers, std::max(1, times / 100)));
    std::vector<std::int64_t> words(70);
    const double start = wall_seconds();
    for (int k = 0; k < times; ++k) all->sum(words);
    sums.push_back((wall_seconds() - start) / times);
  }
  result.data["latency_s"] = median(shortest);
  result.data["bytes_per_s"] = sizeof(double) * numbers / median(longest);
  result.data["reduction_s"] = median(sums);
  result.data["processes"] = all->size();
  result.note += fmt::format(
      " Messages between two processes of the machine take {:.2g} µs for one number. For 8 MB they reach "
      "{:.2g} GB/s in both directions simultaneously. A sum of 70 words over all processes takes {:.2g} "
      "µs.",
      1e6 * median(shortest), 1e-9 * sizeof(double) * numbers / median(longest), 1e6 * median(sums));
}

void measure_gas(const gas& whole, const settings& options, result_table& result) {
  const auto& all = options.processes;
  gas part = whole;
  part.first /= all->size();
  timed_run alone(whole, all, workers::root), part_alone(part, all, workers::root),
      parts_alone(part, all, workers::each_alone), together(whole, all, workers::together);
  std::vector<double> strong, weak, independent, seconds, seconds_alone;
  for (int turn = 0; turn < options.repeats; ++turn) {
    const double shared = together.take(), of_part = part_alone.take();
    seconds_alone.push_back(alone.take());
    strong.push_back(seconds_alone.back() / (all->size() * shared));
    weak.push_back(of_part / shared);
    independent.push_back(of_part / parts_alone.take());
    seconds.push_back(shared);
  }
  const exchanged of = count_exchanges(whole, all);
  const double points =
      static_cast<double>(together.run()->mesh().size()) * together.run()->setup().equation->components();
  result.data["gases"].push_back({{"name", whole.name},
                                  {"dimensions", whole.dimensions},
                                  {"components", together.run()->setup().equation->components()},
                                  {"seconds_per_point", median(seconds_alone) / points},
                                  {"exchanges", of.messages},  // two processes: one message each
                                  {"reductions", of.reductions}});
  result.rows.push_back({whole.name, fmt::format("{:.2g}", points), all->size(), 1e3 * median(seconds),
                         fmt::format("{:.0f} %", 100.0 * median(weak)),
                         fmt::format("{:.0f} %", 100.0 * median(strong)),
                         fmt::format("{:.0f} %", 100.0 * median(independent)), of.messages,
                         fmt::format("{:.3g}", 1e-6 * of.bytes), of.reductions,
                         fmt::format("{:.1f} %", 100.0 * of.blocking / median(seconds)),
                         fmt::format("{:.1f} %", 100.0 * of.waited / median(seconds))});
}

result_table measure(const settings& options) {
  set_threads(1);
  result_table result;
  result.title = "Several processes";
  result.note =
      "The table shows whole steps of runs with one thread on each process. The runs use md-imex-6-3, "
      "finite differences, the limiter and BGK. They compute the sums of the history after every step. "
      "Column `weak` is the time of one process with one block, divided by that of all processes with "
      "the whole mesh. Column `strong` divides the time of one process with the whole mesh by the number "
      "of processes times the time of all. Column `independent` divides the time of one process with one "
      "block by that of unrelated runs. The unrelated runs have one block each, and run on all processes "
      "simultaneously. This ratio is the ceiling of both others. Figures are medians of turns, in which "
      "idle processes sleep. Messages, MB and reductions are those of a process in a step. Blocking is "
      "packing, sending and waiting without other work, in percent of the step. Waiting is the same "
      "within a step.";
  result.columns = {"space × velocity", "points",   "processes", "ms per step", "weak",     "strong",
                    "independent",      "messages", "MB",        "reductions",  "blocking", "waiting"};
  const std::vector<gas> gases =
      options.quick
          ? std::vector<gas>{{"2D2V", 2, 24, 12, 8}}
          : std::vector<gas>{{"1D1V", 1, 80000, 1, 150}, {"2D2V", 2, 160, 160, 24}, {"3D3V", 3, 24, 24, 12}};
  for (const gas& each : gases) measure_gas(each, options, result);
  measure_messages(options, result);
  return result;
}

const registered here({"processes", "weak and strong scaling on several processes", measure, true});

}  // namespace
}  // namespace apsis::bench::processes_table
