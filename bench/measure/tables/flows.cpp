// Throughput of the flows that users run, and where their time goes. Every case of cases/gas and cases/laws
// is compared with the same gas between periodic ends.
#include "../clock.hpp"
#include "../flow.hpp"
#include "../table.hpp"

#include <apsis/config/case.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::flows_table {
namespace {

/// Returns the gas of a case between periodic ends, without bodies, forces and sources. An axisymmetric case
/// becomes Cartesian, with as many velocities across.
case_config periodic(case_config of) {
  of.space.geometry = geometry_choice::cartesian;
  of.space.boundary = "periodic";
  of.faces = {};
  of.solids.clear();
  of.bodies.clear();
  of.force = {};
  of.source_term = {};
  of.parts = std::make_shared<case_parts>();
  return of;
}

/// Returns the shares of the time of some steps: sweeps, collisions, walls, forces, monitor, the rest.
std::array<double, 6> shares_of(simulation& run, int steps) {
  profile::start();
  const double start = wall_seconds();
  advance(run, steps);
  const double all = (wall_seconds() - start) * threads();
  profile::stop();
  std::array<double, 6> shares{};
  shares.back() = 1.0;
  for (const auto& done : profile::read()) {
    const std::size_t group =
        done.which == kernel::walls     ? 2
        : done.which == kernel::forces  ? 3
        : done.which == kernel::monitor ? 4
        : done.which == kernel::points || done.which == kernel::equilibria || done.which == kernel::relaxation
            ? 1
            : 0;
    shares[group] += done.seconds / all;
    shares.back() -= done.seconds / all;
  }
  return shares;
}

void add_row(result_table& result, const std::string& name, double numbers, const settings& options) {
  const case_config config = flow_of_size(name, numbers);
  simulation flow(config), twin(periodic(config));
  advance(flow, 1);  // allocates the buffers
  advance(twin, 1);
  const int steps = steps_to_measure(flow, options.quick);
  const auto seconds = in_turns({[&] { advance(flow, steps); }, [&] { advance(twin, steps); }},
                                options.quick ? 1 : options.repeats);
  const double ratio = median_ratio(seconds, 1, 0) * point_stages(flow) / point_stages(twin);
  std::vector<nlohmann::json> row = {
      name,
      fmt::format("{:.2g}", static_cast<double>(flow.mesh().size()) * flow.setup().equation->components()),
      steps * point_stages(flow) / median(seconds[0]), fmt::format("{:.2f}", ratio)};
  for (const double share : shares_of(flow, steps)) row.emplace_back(fmt::format("{:.0f} %", 100.0 * share));
  result.rows.push_back(std::move(row));
}

result_table measure(const settings& options) {
  result_table result;
  result.title = "The flows of cases/gas and cases/laws";
  result.note =
      "The table shows point·stages per second of whole steps on one thread. Each case is measured "
      "as it is shipped. It is measured again with so many cells that a state of 4 million numbers "
      "exceeds the caches. The ratio compares the rate with that of the periodic twin in the same "
      "turns. The twin has the same model, velocities and mesh, and neither bodies, forces nor "
      "sources. The other columns are shares of the time. They are the sweeps of the transport, "
      "collisions, walls and other ends, forces and sources, checks of every step, and the rest.";
  result.columns = {"case",       "numbers", "point·stages/s", "ratio",   "sweeps",
                    "collisions", "walls",   "forces",         "monitor", "rest"};
  set_threads(1);
  std::vector<std::string> names;
  for (const std::string& name : case_names())
    if (name.starts_with("gas/") || name.starts_with("laws/")) names.push_back(name);
  if (options.quick) names = {"gas/couette", "gas/sod"};
  for (const std::string& name : names) {
    add_row(result, name, 0.0, options);
    if (!options.quick) add_row(result, name, 4e6, options);
  }
  return result;
}

const registered here({"flows", "speed of every shipped flow, and where its time goes", measure});

}  // namespace
}  // namespace apsis::bench::flows_table
