// The cost of a body: steps with it compared with steps of the same flow without it.
#include "../clock.hpp"
#include "../flow.hpp"
#include "../table.hpp"

#include <apsis/exec/parallel.hpp>
#include <apsis/exec/profile.hpp>

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::bodies_table {
namespace {

case_config without_bodies(case_config of) {
  of.bodies.clear();
  of.output.surfaces = {};
  of.parts = std::make_shared<case_parts>();
  return of;
}

/// Returns the time of some steps per unknown in a cut cell. It is the time for lines and fluxes of cut
/// cells, plus that of all work that does not depend on the kind of cell.
double time_of_cut_unknown(simulation& flow, int steps) {
  profile::start();
  const double start = wall_seconds();
  advance(flow, steps);
  double of_all = wall_seconds() - start, of_cut = 0.0;
  profile::stop();
  for (const kernel_totals& done : profile::read()) {
    switch (done.which) {
      case kernel::cut_cells:
        of_cut += done.seconds;
        [[fallthrough]];
      case kernel::edges:
      case kernel::fluxes:
      case kernel::multiples:
      case kernel::walls:
        of_all -= done.seconds;
        break;
      default:;
    }
  }
  return of_cut / cut_unknowns(flow) + of_all / gas_unknowns(flow);
}

void add_row(result_table& result, const std::string& name, double numbers, const settings& options) {
  const case_config config = flow_of_size(name, numbers);
  simulation flow(config), empty(without_bodies(config));
  advance(flow, 1);  // allocates the buffers
  advance(empty, 1);
  const int steps = steps_to_measure(flow, options.quick);
  const auto seconds = in_turns({[&] { advance(flow, steps); }, [&] { advance(empty, steps); }},
                                options.quick ? 1 : options.repeats);
  const double time = median_ratio(seconds, 0, 1), all = gas_unknowns(empty), with = gas_unknowns(flow),
               cut = cut_unknowns(flow),
               of_cut = time_of_cut_unknown(flow, steps) / (median(seconds[1]) / all);
  result.rows.push_back({name, fmt::format("{:.2g}", with), fmt::format("{:.1f} %", 100.0 * cut / with),
                         steps * point_stages(flow) / median(seconds[0]),
                         fmt::format("{:.2f}", with / all / time), fmt::format("{:.1f}", of_cut),
                         fmt::format("{:.1f}", (time * all - (with - cut)) / cut)});
}

result_table measure(const settings& options) {
  result_table result;
  result.title = "The price of a body";
  result.note =
      "The table shows steps on one thread of shipped flows past bodies, and of the same flows with "
      "divided cells. Unknowns are those in the gas. The third column is the share in cut cells. The "
      "ratio compares point·stages per second with the flow without its bodies, in the same turns. The "
      "last columns are the time of an unknown in a cut cell, where an unknown of the flow without "
      "bodies takes 1. Column `cut cell` has the time by the kernels of cut cells. Column `additional` "
      "has the time with all the additional time. Bodies cost most of the additional time elsewhere.";
  result.columns = {"case", "unknowns", "cut", "point·stages/s", "ratio", "cut cell", "additional"};
  set_threads(1);
  const std::vector<std::string> names = {"gas/cylinder", "gas/ellipse", "gas/wing",
                                          "gas/nozzle",   "gas/sphere",  "gas/sphere-axis"};
  for (const std::string& name : names) {
    if (options.quick && name != names.front()) continue;
    add_row(result, name, 0.0, options);
    if (!options.quick) add_row(result, name, 4e6, options);
  }
  return result;
}

const registered here({"bodies", "the price of a body and of a cut cell", measure});

}  // namespace
}  // namespace apsis::bench::bodies_table
