// Throughput of a graphics processor against its ceilings, and against all cores of the host.
#include "../clock.hpp"
#include "../flow.hpp"
#include "../mixed_step.hpp"
#include "../table.hpp"

#include <apsis/config/case.hpp>
#include <apsis/device/device_ceilings.hpp>
#include <apsis/device/find_device.hpp>
#include <apsis/exec/memory.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/processors.hpp>
#include <apsis/run/memory_need.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::device_table {
namespace {

constexpr int velocities = 150;
constexpr const char* method = "md-imex-10-3-long";

/// Returns a gas between two walls, whose equilibria have closed forms at all its temperatures.
case_config gas_between_walls(double points) {
  return parse_case(fmt::format("[model]\nname = \"bgk\"\nepsilon = 0.05\n"
                                "[space]\ncells = {}\nformulation = \"finite-difference\"\n"
                                "[velocity]\nmax = 9.0\npoints = {}\n"
                                "[boundary.left]\nkind = \"diffuse\"\nT = 1.1\n"
                                "[boundary.right]\nkind = \"diffuse\"\nT = 0.9\n"
                                "[time]\nmethod = \"{}\"\nsafety = 1\nend = 1e9\n",
                                std::lround(points / velocities), velocities, method),
                    "device.toml");
}

bool is_real(const std::string& name) {
  const auto kinds = device_backend_entries();
  return std::none_of(kinds.begin(), kinds.end(),
                      [&](const auto* kind) { return !kind->is_real && kind->name == name; });
}

/// The rest of the memory is for tables and other programs.
constexpr double usable = 0.9;

bool fits(const case_config& of, double bytes) {
  return memory_need(run_setup(of), 0).bytes() <= usable * bytes;
}

/// Returns powers of ten, and the largest number of points whose run fits into the device while the host
/// stores three states.
std::vector<double> sizes(const device& on, bool small) {
  if (small) return {3e3, 6e3};
  constexpr double least = 1e5, states_on_host = 3.0;
  const double bytes = memory_need(run_setup(gas_between_walls(least)), 0).bytes() / least;
  const double most =
      usable * std::min(static_cast<double>(on.free_bytes()) / bytes,
                        available_memory().bytes / (states_on_host * static_cast<double>(sizeof(double))));
  std::vector<double> all;
  for (double points = least; points < most; points *= 10.0) all.push_back(points);
  if (!all.empty() && most > 2.0 * all.back()) all.push_back(most);
  return all;
}

/// The most bytes and operations per second of a device, and the fewest per point and stage.
struct ceilings {
  double bytes, multiply_adds, bytes_of_point, operations_of_point;
};

ceilings measure_ceilings(device& on, bool small) {
  mixed_step host(gas_between_walls(small ? 3e3 : 1e5));
  const kernel_work work = host.count_work();
  constexpr std::size_t large = std::size_t{1} << 26, few = std::size_t{1} << 12;
  const std::size_t that_fit = on.free_bytes() / sizeof(double) / 4;
  return {copy_bytes_per_second(on, small ? few : std::min(large, that_fit)), multiply_adds_per_second(on),
          work.bytes / host.point_stages(), work.operations / host.point_stages()};
}

/// Returns the point·stages per second of whole runs, which check the state after each step.
double speed_of_runs(const case_config& gas, const std::shared_ptr<device>& on, const settings& options) {
  simulation run(std::make_unique<run_setup>(gas, single_process(), on));
  const int steps = steps_to_measure(run, options.quick);
  const double seconds =
      median_seconds({[&] { advance(run, steps); }}, options.quick ? 1 : options.repeats, wall_seconds)[0];
  return steps * point_stages(run) / seconds;
}

std::vector<nlohmann::json> row_of(double points, const std::shared_ptr<device>& on, const ceilings& most,
                                   const settings& options) {
  const case_config gas = gas_between_walls(points);
  const double seconds = options.quick ? 0.001 : 0.2;
  double speed = 0.0;
  nlohmann::json of_host = nullptr, ratio = nullptr;
  {
    std::vector<std::unique_ptr<mixed_step>> all;
    all.push_back(std::make_unique<mixed_step>(gas, on));
    if (fits(gas, available_memory().bytes)) all.push_back(std::make_unique<mixed_step>(gas));
    std::vector<job> jobs;
    std::vector<double> work;
    for (auto& one : all) {
      const int steps = one->steps_in(seconds);
      jobs.push_back([&one, steps] { one->take(steps); });
      work.push_back(steps * one->point_stages());
    }
    const auto turns = in_turns(jobs, options.quick ? 1 : options.repeats, wall_seconds);
    speed = work[0] / median(turns[0]);
    if (all.size() > 1) {
      of_host = work[1] / median(turns[1]);
      ratio = fmt::format("{:.3g}", median_ratio(turns, 1, 0) * work[0] / work[1]);
    }
  }
  const auto percent = [](double share) { return fmt::format("{:.0f} %", 100.0 * share); };
  return {std::lround(points / velocities) * velocities,
          speed,
          percent(speed * most.bytes_of_point / most.bytes),
          percent(speed * most.operations_of_point / most.multiply_adds),
          of_host,
          ratio,
          speed_of_runs(gas, on, options)};
}

result_table measure(const settings& options) {
  const std::shared_ptr<device> on = open_device(options.device);
  const bool real = is_real(options.device), small = options.quick || !real;
  set_threads(available_processors());
  const ceilings most = measure_ceilings(*on, small);
  result_table result;
  result.title = "Finite differences on " + on->name();
  result.note = fmt::format(
      "{}The problem is a gas between walls with {} velocities. Steps use {} with the positivity "
      "limiter. The speed is that of steps, in point·stages per second. Copies by a kernel have a "
      "ceiling of {:.3g} bytes per second. Multiply–adds in registers have a ceiling of {:.3g} per "
      "second. Work of a point and stage is the least, with {:.1f} bytes and {:.1f} operations as "
      "counted on the host. The host has {} thread{}. Its steps alternate with those of the device. The "
      "last column is the speed of whole runs, which check the state after each step.",
      real ? "" : "No figure is that of a device (lanes on the host took its part). ", velocities, method,
      most.bytes, most.multiply_adds, most.bytes_of_point, most.operations_of_point, threads(),
      threads() == 1 ? "" : "s");
  result.columns = {"points", "point·stages/s", "of copies", "of multiply–adds",
                    "host",   "ratio to it",    "runs"};
  result.data = {{"device", on->name()},
                 {"is_device", real},
                 {"copy_bytes_per_second", most.bytes},
                 {"multiply_adds_per_second", most.multiply_adds}};
  for (const double points : sizes(*on, small)) result.rows.push_back(row_of(points, on, most, options));
  set_threads(1);
  return result;
}

const registered here({.name = "device",
                       .description = "throughput of a graphics processor against its ceilings and the host",
                       .measure = measure,
                       .needs_device = true});

}  // namespace
}  // namespace apsis::bench::device_table
