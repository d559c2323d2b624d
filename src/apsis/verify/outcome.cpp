#include <apsis/verify/outcome.hpp>

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
  // The velocities of a grid have equal weights; those of other models have no part in norms.
  if (config.velocity.points > 0) out.component_weight = run.velocities().weights().front();
  return out;
}

outcome compute_outcome(const std::string& name, const std::vector<std::string>& overrides,
                        const study_control& control) {
  return compute_outcome(load_case(name, overrides), control);
}

}  // namespace apsis
