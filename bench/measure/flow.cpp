#include "clock.hpp"
#include "flow.hpp"

#include <apsis/mesh/cut_cells.hpp>
#include <apsis/run/setup.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace apsis::bench {

case_config flow_of_size(const std::string& name, double numbers) {
  case_config of = load_case(name);
  of.time.steady.reset();
  of.time.end = 1e9;
  of.output.every = 0.0;
  const auto dimensions = static_cast<double>(of.space.cells.size());
  const simulation small(of);
  const double now = static_cast<double>(small.mesh().size()) * small.setup().equation->components();
  const int parts = std::max(1, static_cast<int>(std::ceil(std::pow(numbers / now, 1.0 / dimensions))));
  for (int& cells : of.space.cells) cells *= parts;
  return of;
}

double gas_unknowns(const simulation& of) {
  double cells = 0.0;
  std::set<int> groups;
  for (const cell_range& range : of.mesh().fluid())
    for (int cell = range.begin; cell < range.end; ++cell)
      if (const int group = of.mesh().cut_group(cell); group < 0)
        cells += 1.0;
      else
        groups.insert(group);
  return (cells + static_cast<double>(groups.size())) * of.setup().equation->components();
}

double cut_unknowns(const simulation& of) {
  const cut_cells* cut = of.mesh().cut();
  return cut ? static_cast<double>(cut->groups().size()) * of.setup().equation->components() : 0.0;
}

double point_stages(const simulation& of) {
  return gas_unknowns(of) * static_cast<double>(of.setup().stages());
}

void advance(simulation& run, int steps) {
  for (int k = 0; k < steps; ++k) run.advance();
}

int steps_to_measure(simulation& run, bool quick) {
  const double start = wall_seconds();
  advance(run, 1);
  return std::max(1, static_cast<int>((quick ? 0.001 : 0.1) / (wall_seconds() - start)));
}

}  // namespace apsis::bench
