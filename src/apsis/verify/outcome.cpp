#include <apsis/verify/outcome.hpp>

#include <cmath>

namespace apsis {

outcome compute_outcome(const case_config& config, const study_control& control) {
  simulation run(config);
  while (!run.finished()) {
    control.check();
    run.advance();
  }
  outcome out;
  out.config = run.config();
  out.summary = run.summary();
  out.fields = run.fields();
  out.cells = run.cells();
  out.components = run.components();
  out.state = run.state();
  out.exact = run.exact_state();
  if (run.has_space()) out.cell_volume = make_mesh(config).cell_volume();
  if (config.velocity.points > 0) {
    // One velocity cell; components are all nodes of a grid with the same number per dimension.
    const double dimensions = std::round(std::log(out.components) / std::log(config.velocity.points));
    out.component_weight = std::pow(2.0 * config.velocity.max / config.velocity.points, dimensions);
  }
  return out;
}

outcome compute_outcome(const std::string& name, const std::vector<std::string>& overrides,
                        const study_control& control) {
  return compute_outcome(load_case(name, overrides), control);
}

}  // namespace apsis
